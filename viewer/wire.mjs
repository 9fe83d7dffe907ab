// What the stream costs: wire.mjs PORT [SECONDS [CLIENTS]] listens to a daemon and tells how many
// bytes and messages a second each client gets.
import WebSocket from 'ws';

const [port, seconds = 20, count = 1] = process.argv.slice(2).map(Number);
const clients = Array.from({ length: count }, () => {
  const client = { bytes: 0, messages: 0 };
  new WebSocket(`ws://127.0.0.1:${port}/v1/stream`).on('message', (data) => {
    client.bytes += data.length;
    client.messages += 1;
  });
  return client;
});
setTimeout(() => {
  for (const { bytes, messages } of clients)
    console.log(`${(bytes / 1000 / seconds).toFixed(2)} kB/s, ${(messages / seconds).toFixed(1)} messages/s`);
  process.exit();
}, 1000 * seconds);

// The world as Foxglove's own client sees it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import FoxgloveWs from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { Daemon, START } from './daemon.mjs';

const { FoxgloveClient } = FoxgloveWs;
const CUP = ['cup', 'blue', 2, 1.5, 0.9];
const PERSON = ['person', 'red', 6, 3, 0.9];

let daemon;
before(async () => {
  daemon = new Daemon();
  await daemon.start();
});
after(() => daemon.stop());

/** A client that has subscribed to everything, and what it has heard by topic. */
async function listen(protocol) {
  const socket = new WebSocket(daemon.url.replace('http', 'ws'), [protocol]);
  const client = new FoxgloveClient({ ws: socket });
  const heard = { topics: new Map(), '/anchord/scene': [], '/anchord/log': [] };
  const bySubscription = new Map();
  client.on('advertise', (channels) => {
    for (const channel of channels) {
      heard.topics.set(channel.topic, channel);
      bySubscription.set(client.subscribe(channel.id), channel.topic);
    }
  });
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    const message = JSON.parse(new TextDecoder().decode(data));
    heard[bySubscription.get(subscriptionId)].push({ timestamp, ...message });
  });
  heard.info = await new Promise((told) => client.on('serverInfo', told));
  return { client, heard };
}

async function until(so, what) {
  const end = Date.now() + 20_000;
  while (!so()) {
    if (Date.now() > end) assert.fail(`never: ${what}`);
    await new Promise((later) => setTimeout(later, 20));
  }
}

test('objects come, move and are named', async () => {
  await daemon.see([CUP]);
  const { client, heard } = await listen(FoxgloveClient.SUPPORTED_SUBPROTOCOL);
  assert.equal(heard.info.name, 'anchord');
  await until(() => heard['/anchord/scene'].length > 0, 'a scene');
  const channel = heard.topics.get('/anchord/scene');
  assert.equal(channel.schemaName, 'foxglove.SceneUpdate');
  assert.equal(channel.encoding, 'json');
  assert.equal(JSON.parse(channel.schema).title, 'foxglove.SceneUpdate');
  const [first] = heard['/anchord/scene'];
  assert.deepEqual(first.entities.map((entity) => entity.id), ['cup-1']);
  const [cup] = first.entities;
  assert.equal(cup.frame_id, 'map');
  assert.ok(Math.abs(cup.cubes[0].pose.position.x - 2) < 0.05);
  assert.deepEqual(cup.cubes[0].size, { x: 0.1, y: 0.1, z: 0.12 });
  assert.match(cup.texts[0].text, /^cup-1 /);
  assert.equal(first.timestamp, BigInt(START + daemon.number * 200_000) * 1000n);
  await daemon.see([CUP, PERSON]);
  const seen = (id) => heard['/anchord/scene'].some((update) => update.entities.some((e) => e.id === id));
  await until(() => seen('person-1'), 'a person');
  await until(() => heard['/anchord/log'].some((line) => /^person-1 is there, hall/.test(line.message)), 'a line');
  client.close();
});

test('the other name of the protocol is spoken, too', async () => {
  const socket = new WebSocket(daemon.url.replace('http', 'ws'), ['foxglove.sdk.v1']);
  const first = await new Promise((heard) => socket.once('message', (bytes) => heard(JSON.parse(bytes))));
  assert.equal(socket.protocol, 'foxglove.sdk.v1');
  assert.equal(first.op, 'serverInfo');
  socket.close();
});

test('what the protocol does not have ends the connection with a reason', async () => {
  const socket = new WebSocket(daemon.url.replace('http', 'ws'), ['foxglove.sdk.v1']);
  await new Promise((open) => socket.once('open', open));
  socket.send('{"op": "subscribe", "subscriptions": [{"id": -1}]}');
  const [code, reason] = await new Promise((closed) => socket.once('close', (...why) => closed(why)));
  assert.equal(code, 1008);
  assert.match(String(reason), /subscriptions/);
});

// Pictures of the plaza and the home for the documents, made by the page itself: pictures.mjs [DIR].
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { freePort } from './test/daemon.mjs';

const ROOT = fileURLToPath(new URL('..', import.meta.url));
const BUILD = join(ROOT, 'build');
const OUT = process.argv[2] ?? join(ROOT, 'docs');
const PATIENCE = 60_000; // ms
const HOME_SECONDS = 600;
const BATCH = 40; // frames

/** A daemon with a configuration, while `then` uses it. */
async function withDaemon(config, lcm, then) {
  const folder = mkdtempSync(join(tmpdir(), 'anchord-pictures-'));
  const url = `http://127.0.0.1:${await freePort()}`;
  const daemon = spawn(join(BUILD, 'anchord'), ['--config', join(ROOT, config), '--data', folder,
    '--lcm', lcm, '--http', url.slice('http://'.length)], { stdio: 'ignore' });
  try {
    for (;;) {
      if (await fetch(url + '/v1/status').then((r) => r.json()).then((s) => s.ready, () => false)) break;
      await new Promise((later) => setTimeout(later, 50));
    }
    await then(url);
  } finally {
    daemon.kill();
    await once(daemon, 'exit');
    rmSync(folder, { recursive: true });
  }
}

/** Ten minutes of the home that ./dev soak lives in. */
async function playHome(url) {
  const home = spawn(join(BUILD, 'soak_home'), ['--config', join(ROOT, 'config/home.json'), '--seed', '5',
    '--seconds', String(HOME_SECONDS)], { stdio: ['ignore', 'pipe', 'inherit'] });
  let batch = [];
  const send = async () => {
    const answer = await fetch(url + '/v1/detections', { method: 'POST', body: `[${batch}]`,
      headers: { 'Content-Type': 'application/json' } });
    if (!answer.ok) throw new Error(await answer.text());
    batch = [];
  };
  for await (const line of createInterface(home.stdout)) {
    const { frame } = JSON.parse(line);
    if (frame) batch.push(JSON.stringify(frame));
    if (batch.length === BATCH) await send();
  }
  if (batch.length) await send();
}

async function playPlaza(lcm) {
  const play = spawn(join(BUILD, 'anchor-play'), ['--lcm', lcm, '--speed', '4', join(ROOT, 'data/plaza.lcm')],
    { stdio: 'ignore' });
  const [status] = await once(play, 'exit');
  if (status !== 0) throw new Error('the plaza could not be played: is there a multicast route?');
}

async function picture(browser, url, file, question) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.setDefaultTimeout(PATIENCE);
  await page.goto(url);
  await page.locator('#objects button').first().waitFor();
  await page.fill('#ask', question);
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.getElementById('answer').textContent);
  await page.waitForTimeout(3000); // until the line of the status has its rates
  await page.screenshot({ path: join(OUT, file) });
  await page.close();
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--headless=new', '--no-sandbox', '--enable-unsafe-swiftshader', '--disable-background-networking'],
});
const lcm = `udpm://239.255.76.67:${await freePort()}?ttl=0`;
await withDaemon('config/plaza.json', lcm, async (url) => {
  await playPlaza(lcm);
  await picture(browser, url, 'viewer-plaza.png', 'where person red');
});
await withDaemon('config/home.json', 'memq://', async (url) => {
  await playHome(url);
  await picture(browser, url, 'viewer-home.png', 'where person');
});
await browser.close();

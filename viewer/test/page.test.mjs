// The page in a real browser, beside a real daemon.
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, beforeEach, test } from 'node:test';
import { chromium } from 'playwright-core';
import { Daemon } from './daemon.mjs';

const PICTURES = process.env.ANCHORD_PICTURES ?? join(tmpdir(), 'anchord-pictures');
const PATIENCE = 20_000; // ms

let browser, daemon, page, complaints;

before(async () => {
  mkdirSync(PICTURES, { recursive: true });
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--headless=new', '--no-sandbox', '--enable-unsafe-swiftshader', '--disable-background-networking'],
  });
});
after(() => browser.close());

beforeEach(async () => {
  daemon = new Daemon();
  await daemon.start();
  page = await open();
});
afterEach(async () => {
  await page.context().close();
  await daemon.stop();
});

async function open(options = {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 760 }, ...options });
  const opened = await context.newPage();
  opened.setDefaultTimeout(PATIENCE);
  complaints = [];
  opened.on('console', (message) => {
    const own = !message.text().includes('GPU stall due to ReadPixels'); // of taking a picture
    if (own && ['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  opened.on('pageerror', (error) => complaints.push(String(error)));
  await opened.goto(daemon.url);
  return opened;
}

const row = (id) => page.locator(`#objects button[data-id="${id}"]`);
const ids = () => page.locator('#objects button').evaluateAll((rows) => rows.map((r) => r.dataset.id));

/** Until something is so. */
async function until(so, what) {
  const end = Date.now() + PATIENCE;
  while (!(await so())) {
    if (Date.now() > end) assert.fail(`never: ${what}`);
    await new Promise((later) => setTimeout(later, 50));
  }
}

const CUP = ['cup', 'blue', 2, 1.5, 0.9];
const OTHER = ['cup', 'red', 2.5, 5, 0.9];
const PERSON = ['person', 'red', 6, 3, 0.9];

test('shows the objects that the API says, without a complaint', async () => {
  await daemon.see([CUP, OTHER, PERSON]);
  await until(async () => (await ids()).length === 3, 'three objects');
  const { objects } = await daemon.get('/v1/objects?min_p=0.5');
  assert.deepEqual((await ids()).sort(), objects.map((o) => o.id).sort());
  for (const o of objects) {
    const text = await row(o.id).innerText();
    assert.ok(text.includes((o.place ?? '').replaceAll('_', ' ')), text);
    assert.ok(text.includes(o.p.toFixed(2)), text);
  }
  await page.screenshot({ path: `${PICTURES}/kitchen.png` });
  assert.deepEqual(complaints, []);
});

test('a moved cup moves', async () => {
  await daemon.see([CUP]);
  await row('cup-1').click();
  await page.getByText(/^table \(2\.0\d, 1\.\d\d, 0\.\d\d\) m$/).waitFor();
  const before = await page.locator('#stage').screenshot();
  await daemon.see([['cup', 'blue', 2, 5, 0.9]], 12);
  await page.getByText(/^sink \([12]\.\d\d, [45]\.\d\d, 0\.\d\d\) m$/).waitFor();
  assert.ok((await row('cup-1').innerText()).includes('sink'));
  assert.notDeepEqual(await page.locator('#stage').screenshot(), before);
});

test('answers questions, in words and by keyboard', async () => {
  await daemon.see([CUP, OTHER, PERSON]);
  await row('cup-1').waitFor();
  await page.keyboard.press('/');
  await page.keyboard.type('where is the blue cup?');
  await page.keyboard.press('Enter');
  const answer = page.locator('#answer');
  await until(async () => (await answer.innerText()).includes('table'), 'an answer');
  const where = await daemon.get('/v1/where?class=cup&color=blue');
  assert.ok((await answer.innerText()).startsWith(where.answers[0].object));
  await page.fill('#ask', 'how many people in hall');
  await page.keyboard.press('Enter');
  await until(async () => (await answer.innerText()).includes('expected'), 'a count');
  const count = await daemon.get('/v1/count?class=person&place=hall');
  assert.ok((await answer.innerText()).includes(count.expected.toFixed(2)));
  await page.fill('#ask', 'where unicorn');
  await page.keyboard.press('Enter');
  await until(async () => (await answer.innerText()).includes('"unicorn" is no'), 'a refusal');
});

test('the time line shows the past, and comes back', async () => {
  await daemon.see([CUP], 25); // five seconds on the table
  await daemon.see([['cup', 'blue', 2, 5, 0.9]], 25);
  await until(async () => (await row('cup-1').innerText()).includes('sink'), 'at the sink');
  await page.selectOption('#span', '60');
  await page.locator('#when').evaluate((slider) => {
    slider.value = String(1000 * (1 - 8 / 60));
    slider.dispatchEvent(new Event('input'));
  });
  await until(async () => (await row('cup-1').innerText()).includes('table'), 'on the table again');
  assert.equal(await page.locator('body').getAttribute('data-time'), 'past');
  await page.click('#live');
  await until(async () => (await row('cup-1').innerText()).includes('sink'), 'live again');
});

test('a restart of the daemon is survived', async () => {
  await daemon.see([CUP]);
  await row('cup-1').waitFor();
  await daemon.end('SIGKILL');
  await until(async () => (await page.locator('#status').getAttribute('class')) === 'lost', 'no connection');
  await daemon.start();
  await daemon.see([CUP, PERSON]);
  await row('person-1').waitFor();
});

test('twenty at once', async () => {
  const listeners = await page.evaluateHandle(() =>
    Array.from({ length: 20 }, () => {
      const listener = { utime: 0, messages: 0 };
      new WebSocket(location.origin.replace('http', 'ws') + '/v1/stream').onmessage = (event) => {
        const message = JSON.parse(event.data);
        listener.messages += 1;
        listener.utime = (message.world ?? message.change).utime ?? listener.utime;
      };
      return listener;
    }));
  const heard = () => listeners.evaluate((all) => all);
  await until(async () => (await heard()).every((one) => one.messages > 0), 'all have the world');
  await daemon.see([CUP, OTHER], 20);
  const { utime } = await daemon.get('/v1/status');
  await until(async () => (await heard()).every((one) => one.utime === utime), 'all have the last frame');
  await row('cup-2').waitFor();
  assert.equal((await daemon.get('/v1/status')).http.streams, 21);
  assert.deepEqual(complaints, []);
});

test('on a telephone, in the dark', async () => {
  const telephone = await open({ viewport: { width: 390, height: 780 }, colorScheme: 'dark', hasTouch: true });
  await daemon.see([CUP, OTHER, PERSON]);
  await telephone.locator('#objects button[data-id="person-1"]').click();
  await telephone.locator('#details').waitFor();
  await telephone.screenshot({ path: `${PICTURES}/telephone.png` });
  const wide = await telephone.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `${wide} pixels wide`);
  assert.deepEqual(complaints, []);
  await telephone.context().close();
});

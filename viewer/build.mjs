// Bundles the page: build.mjs [DIR], by default dist/.
import { build } from 'esbuild';
import { copyFileSync, mkdirSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, 'dist');
mkdirSync(out, { recursive: true });
await build({
  entryPoints: [join(here, 'src/main.ts')],
  outfile: join(out, 'main.js'),
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  legalComments: 'eof',
});
for (const file of ['index.html', 'style.css', 'icon.svg'])
  copyFileSync(join(here, 'src', file), join(out, file));
copyFileSync(join(here, 'node_modules/three/LICENSE'), join(out, 'three.LICENSE.txt'));

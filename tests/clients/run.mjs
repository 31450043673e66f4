// node run.mjs JOB CHROMIUM PROGRAM...: each program draws what the folder JOB asks for. JOB/failed.json holds what went wrong in
// which. Exit code 3 if Chromium does not start.
import {createServer} from 'node:http';
import {readFile, writeFile} from 'node:fs/promises';
import {dirname, extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';
import {chromium} from 'playwright-core';

const [job, executablePath, ...programs] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const TYPES = {'.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json', '.wasm': 'application/wasm', '.css': 'text/css'};
const FLAGS = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];

// Serves this folder, and JOB as /job/, which is written to as well; to this machine alone.
const server = createServer(async (request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
  const file = path.startsWith('/job/') ? join(job, path.slice(5)) : join(here, path);
  try {
    if (request.method === 'POST') {
      const parts = [];
      for await (const part of request) parts.push(part);
      await writeFile(file, Buffer.concat(parts));
      response.end();
    } else {
      response.writeHead(200, {'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream'});
      response.end(await readFile(file));
    }
  } catch (error) {
    if (!response.headersSent) response.writeHead(404);
    response.end(String(error));
  }
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));

// Headless, in a fresh profile.
const browser = await chromium.launch({executablePath, args: FLAGS}).catch((error) => {
  console.error(error.message);
  process.exit(3);
});
const failed = {};
for (const name of programs) {
  const page = await browser.newPage({viewport: {width: 128, height: 128}});
  const said = [];
  page.on('console', (message) => said.push(message.text()));
  page.on('pageerror', (error) => said.push(String(error)));
  try {
    await page.goto(`http://127.0.0.1:${server.address().port}/browser/page.html?program=${name}`);
    await page.waitForFunction(() => 'finished' in window);
    await page.evaluate(() => window.finished);
  } catch (error) {
    failed[name] = [error.message, ...said].join('\n');
  }
  await page.close();
}
await writeFile(join(job, 'failed.json'), JSON.stringify(failed));
await browser.close();
server.close();

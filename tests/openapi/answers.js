// answers.js DOCUMENT ORIGIN TOKEN: holds every answer that the document describes, but for those
// that are hard to provoke, against that of a guarded server that serves a mesh called `sphere`.
import http from 'node:http';
import { checkAnswer, readDocument, require } from './document.js';

const [file, origin, token] = process.argv.slice(2);
const document = await readDocument(file);
const checked = new Set();

const authorization = { Authorization: `Bearer ${token}` };
const upgrade = {
  Connection: 'Upgrade',
  Upgrade: 'websocket',
  'Sec-WebSocket-Version': '13',
  'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ==',
};
const wrongSignature = `expires=9999999999&signature=${'0'.repeat(64)}`;

function ask(method, target, headers) {
  return new Promise((resolve, reject) => {
    const request = http.request(origin + target, { method, headers, agent: false });
    request.on('upgrade', ({ statusCode, headers }, socket) => {
      socket.destroy();
      resolve({ status: statusCode, headers, body: Buffer.alloc(0) });
    });
    request.on('response', (response) => {
      const pieces = [];
      response.on('data', (piece) => pieces.push(piece));
      response.on('end', () => {
        const { statusCode: status, headers } = response;
        resolve({ status, headers, body: Buffer.concat(pieces), isHead: method === 'HEAD' });
      });
    });
    request.on('error', reject);
    request.end();
  });
}

/** Asks for `target`, a case of the route `path`; without `headers` as one who is granted access. */
async function check(path, target, status, headers = authorization) {
  for (const method of status === 101 || status === 206 || status === 416 ? ['GET'] : ['GET', 'HEAD']) {
    const answer = await ask(method, target, headers);
    const what = `${method} ${target}`;
    require(answer.status === status, `${what}: ${answer.status} instead of ${status}: ${answer.body}`);
    checkAnswer(document, path, answer, what);
  }
  checked.add(`${path} ${status}`);
}

/** What every route of a mesh answers alike. */
async function checkMeshRoute(path, target) {
  await check(path, target, 401, {});
  await check(path, `${target}?${wrongSignature}`, 403, {});
  await check(path, `${target}?${wrongSignature}&expires=1`, 400);
  await check(path, target.replace('sphere', 'absent'), 404);
}

async function checkUnchanged(path, target) {
  const { headers } = await ask('HEAD', target, authorization);
  await check(path, target, 304, { ...authorization, 'If-None-Match': headers.etag });
}

for (const target of ['/', '/catalog', '/health', '/metrics', '/openapi.json', '/view/sphere']) {
  await check(target.replace('sphere', '{id}'), target, 200);
}
await check('/catalog', '/catalog', 401, {});
await checkUnchanged('/catalog', '/catalog');
await check('/metrics', '/metrics', 401, {});

await checkMeshRoute('/{id}', '/sphere');
await check('/{id}', '/sphere', 200);
await checkUnchanged('/{id}', '/sphere');
const mesh = JSON.parse((await ask('GET', '/sphere', authorization)).body);

const fileRoute = '/{id}/{hash}.pmesh';
await checkMeshRoute(fileRoute, mesh.url);
await check(fileRoute, mesh.url, 200);
for (const wish of ['faces=1', 'vertices=500', 'ratio=0.5', 'error=1%25', 'bytes=5000', 'chunks=0-1', 'chunks=1-1']) {
  await check(fileRoute, `${mesh.url}?${wish}`, 200);
}
await check(fileRoute, `${mesh.url}?faces=1&vertices=1`, 400);
await check(fileRoute, mesh.url, 206, { ...authorization, Range: 'bytes=0-99' });
await check(fileRoute, mesh.url, 416, { ...authorization, Range: `bytes=${mesh.file_bytes}-` });
await checkUnchanged(fileRoute, mesh.url);

const chunkRoute = '/{id}/{hash}/c/{n}';
const chunk = mesh.url.replace('.pmesh', '/c/0');
await checkMeshRoute(chunkRoute, chunk);
await check(chunkRoute, chunk, 200);
await checkUnchanged(chunkRoute, chunk);

const levelRoute = '/{id}/lod.{format}';
await checkMeshRoute(levelRoute, '/sphere/lod.glb');
for (const level of ['lod.glb', 'lod.glb?draco=1', 'lod.ply?faces=1', 'lod.obj?ratio=0.5', 'lod.drc?draco=0&error=1%25']) {
  await check(levelRoute, `/sphere/${level}`, 200);
}
await check(levelRoute, '/sphere/lod.glb?chunks=1-1', 400);
await checkUnchanged(levelRoute, '/sphere/lod.ply?faces=500');

const streamRoute = '/{id}/stream';
await checkMeshRoute(streamRoute, '/sphere/stream');
await check(streamRoute, '/sphere/stream', 101, { ...authorization, ...upgrade });
await check(streamRoute, '/sphere/stream', 426);

const notProvoked = ['500', '503'];
// Only with metrics on a port of their own, and only of a server that is open to all.
const otherServers = ['/metrics 404', '/view/{id} 404'];
const described = Object.entries(document.paths).flatMap(([path, { get }]) =>
  Object.keys(get.responses).filter((status) => !notProvoked.includes(status)).map((status) => `${path} ${status}`));
const missed = described.filter((answer) => !checked.has(answer) && !otherServers.includes(answer));
require(missed.length === 0, `described, but not checked: ${missed.join(', ')}`);
console.log(`${checked.size} answers are as described`);

// docs/openapi.json: valid OpenAPI, its references resolved, and each answer that it describes.
import { readFileSync } from 'node:fs';
import { Validator } from '@seriousme/openapi-schema-validator';
import Ajv from 'ajv/dist/2020.js';
import addFormats from 'ajv-formats';

const ajv = addFormats.default(new Ajv.default({ strictSchema: true, allowUnionTypes: true }));

export function require(condition, what) {
  if (!condition) throw new Error(what);
}

function requireValid(schema, value, what) {
  require(ajv.validate(schema, value), `${what}: ${JSON.stringify(value)}: ${ajv.errorsText()}`);
}

export async function readDocument(file) {
  const validator = new Validator();
  const { valid, errors } = await validator.validate(JSON.parse(readFileSync(file, 'utf8')));
  require(valid, `${file} is no OpenAPI document: ${JSON.stringify(errors, null, 1)}`);
  return validator.resolveRefs();
}

/** Holds an answer {status, headers, body} against what the document says of it. */
export function checkAnswer(document, path, answer, what) {
  const described = document.paths[path]?.get.responses[answer.status];
  require(described, `${what}: status ${answer.status} is not described`);
  for (const [name, header] of Object.entries(described.headers ?? {})) {
    checkHeader(header, answer.headers[name.toLowerCase()], `${what}: ${name}`);
  }
  checkBody(described.content, answer, what);
}

function checkHeader({ schema, required }, value, what) {
  require(value !== undefined || !required, `${what} is missing`);
  if (value !== undefined) requireValid(schema, /^[0-9]+$/.test(value) ? Number(value) : value, what);
}

function checkBody(content, { headers, body, isHead }, what) {
  if (!content) return require(body.length === 0, `${what}: a body that is not described`);
  const type = headers['content-type'];
  require(content[type], `${what}: the type ${type} is not described`);
  if (isHead) return require(body.length === 0, `${what}: a body`);
  require(body.length === Number(headers['content-length']), `${what}: the body is cut`);
  const { schema } = content[type];
  const isBinary = schema.contentEncoding === 'binary';
  if (type === 'application/json') requireValid(schema, JSON.parse(body), what);
  else if (!isBinary) requireValid(schema, body.toString('utf8'), what);
}

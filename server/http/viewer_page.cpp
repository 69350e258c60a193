#include "server/http/viewer_page.h"

namespace pmesh {

std::string_view viewer_page() {
  return R"html(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>pmesh</title>
<style>
body { font: 1rem/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 60rem; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: right; padding: .3rem .6rem; border-bottom: 1px solid #8886; }
th:first-child, td:first-child { text-align: left; }
</style>
<h1>pmesh</h1>
<p id="state" role="status">Loading the catalogue &hellip;</p>
<table hidden>
<thead><tr><th>mesh<th>faces<th>vertices<th>bytes<th>glTF of 10,000 faces</thead>
<tbody></tbody>
</table>
<p>Any level of detail: <code>pmesh fetch <span id="origin"></span>/ID --faces 20000 -o lod.obj</code>.
Interface: <a href="openapi.json">openapi.json</a>.
<script>
const state = document.getElementById('state');
document.getElementById('origin').textContent = location.origin;

function cell(row, content) { row.insertCell().append(content); }

function link(href, text) {
  const a = document.createElement('a');
  a.href = href;
  a.textContent = text;
  return a;
}

function show(meshes) {
  const body = document.querySelector('tbody');
  for (const mesh of meshes) {
    const row = body.insertRow();
    cell(row, link(mesh.id, mesh.id));
    cell(row, mesh.faces.toLocaleString());
    cell(row, mesh.vertices.toLocaleString());
    cell(row, mesh.file_bytes.toLocaleString());
    cell(row, link(`${mesh.id}/lod.glb?faces=10000`, 'lod.glb'));
  }
  state.textContent = `${meshes.length} meshes`;
  document.querySelector('table').hidden = false;
}

fetch('catalog')
  .then((answer) => answer.ok ? answer.json() : Promise.reject(new Error(answer.statusText)))
  .then(show)
  .catch((error) => { state.textContent = `The catalogue cannot be read: ${error.message}`; });
</script>
</html>
)html";
}

}  // namespace pmesh

// node build.mjs SOURCE_FOLDER OUT.cpp: bundles the page and writes it as a C++ source, so that the
// program carries it. Runs in a folder with node_modules; the sources are copied there.
import { build } from 'esbuild';
import { cpSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [source, out] = process.argv.slice(2);
rmSync('src', { recursive: true, force: true });
cpSync(join(source, 'src'), 'src', { recursive: true });
const result = await build({
  entryPoints: { page: 'src/main.ts', style: 'src/page.css' },
  outdir: 'dist',
  bundle: true,
  minify: true,
  target: 'es2022',
  format: 'esm',
  legalComments: 'eof',
  logLevel: 'warning',
  write: false,
});
const files = [['index.html', 'text/html; charset=utf-8', readFileSync('src/index.html')]];
for (const [name, type] of [
  ['page.js', 'text/javascript; charset=utf-8'],
  ['style.css', 'text/css; charset=utf-8'],
]) {
  const made = result.outputFiles.find((file) => file.path.endsWith(name));
  files.push([name, type, Buffer.from(made.contents)]);
}
const arrays = files.map(
  ([, , bytes], i) => `constexpr unsigned char kFile${i}[] = {${Array.from(bytes).join(',')}};\n`,
);
const cases = files.map(
  ([name, type], i) =>
    `  if (path == "${name}")\n    return PageFile{"${type}", {reinterpret_cast<const char*>(kFile${i}), sizeof kFile${i}}};\n`,
);
writeFileSync(
  out,
  `#include "apps/label_server/http/page_files.hpp"

namespace roadbook {
namespace {

${arrays.join('')}
}  // namespace

std::optional<PageFile> page_file(std::string_view path) {
${cases.join('')}  return std::nullopt;
}

}  // namespace roadbook
`,
);

// The bundler drops types without a look at them: the compiler checks them here.
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';

const [folder] = process.argv.slice(2);
const compiler = join(folder, 'node_modules/typescript/bin/tsc');
if (!existsSync(compiler) || !existsSync(join(folder, 'src'))) {
  console.log('not run: the page was not built');
  process.exit(77);
}
process.exit(spawnSync(process.execPath, [compiler, '-p', folder], { stdio: 'inherit' }).status);

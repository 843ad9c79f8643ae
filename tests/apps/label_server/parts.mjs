// Runs tests of the page one after another in one browser: PROGRAM MAKE_LOT PAGE_FOLDER TEST...
import { closeBrowser, keepBrowser } from './browser.mjs';

keepBrowser();
for (const part of process.argv.slice(5)) {
  console.log(`-- ${part}`);
  try {
    await import(`./${part}.mjs`);
  } catch (fault) {
    console.log(`${part}: ${fault.stack}`);
    process.exitCode = 1;
  }
}
await closeBrowser();

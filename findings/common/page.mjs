// A page of 800 by 600, all of it <main>, which has run out/LIBRARY.js: node look.mjs LIBRARY WORD... The words are the
// page's `given`.
import fs from 'fs';
import {chromium} from 'playwright-core';
export const [library, ...given] = process.argv.slice(2);
export const browser =
  await chromium.launch({executablePath: 'root/usr/lib/chromium/chromium', args: ['--no-sandbox', '--disable-gpu']});
export const page = await browser.newPage({viewport: {width: 800, height: 600}});
export const pause = (milliseconds = 1000) => page.waitForTimeout(milliseconds);
await page.setContent('<!doctype html><body style="margin: 0"><main style="width: 800px; height: 600px"></main>');
await page.evaluate((words) => { window.given = words; }, given);
if (fs.existsSync(`out/${library}.css`)) await page.addStyleTag({path: `out/${library}.css`});
await page.addScriptTag({path: `out/${library}.js`});
await pause();

// SPDX-License-Identifier: MPL-2.0
// node tools/search_site.js FOLDER < QUERIES: what the search of a built site finds, a line of JSON for each line of stdin:
// the pages in the order in which they are shown. It runs the scripts of the site's search page themselves.
'use strict';
const {readFileSync} = require('node:fs'), {join} = require('node:path'), vm = require('node:vm');

const folder = process.argv[2];
const scripts = [...readFileSync(join(folder, 'search.html'), 'utf8').matchAll(/src="([^"?]*(?:searchtools|language_data|searchindex)\.js)/g)];
const compiled = scripts.map(([, name]) => new vm.Script(readFileSync(join(folder, name), 'utf8'), {filename: name}));

for (const query of readFileSync(0, 'utf8').split('\n').filter((line) => line)) {
  const page = { // a search loads the page anew
    URLSearchParams, console, query, SPHINX_HIGHLIGHT_ENABLED: false, _ready: () => {}, _: (text) => text,
    document: {getElementById: () => null}, location: {search: '?' + new URLSearchParams({q: query})},
  };
  page.window = page;
  vm.createContext(page);
  for (const script of compiled) script.runInContext(page);
  const results = vm.runInContext('Search._performSearch(...Search._parseQuery(query)).reverse()', page);
  const shown = results.map(([name, title, anchor, , score]) => [name + anchor, title, score]);
  console.log(JSON.stringify(shown.slice(0, 10)));
}

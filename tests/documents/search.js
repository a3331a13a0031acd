// Answers questions with the search of a site, as its page does: search.js FOLDER QUERY... prints a list of places for each.
const fs = require("fs");
const [folder, ...queries] = process.argv.slice(2);
const workers = folder + "/assets/javascripts/workers/";
const hear = [];
globalThis.self = globalThis;
globalThis.addEventListener = (type, listener) => hear.push(listener);
globalThis.importScripts = () => {};
let at = -1;
globalThis.postMessage = (message) => {
  if (message.type === 3) console.log(JSON.stringify(message.data.items.map((sections) => sections[0].location)));
  if (++at < queries.length) hear[0]({data: {type: 2, data: queries[at]}});
};
eval(fs.readFileSync(workers + fs.readdirSync(workers).find((name) => /^search.*js$/.test(name)), "utf8"));
const index = JSON.parse(fs.readFileSync(folder + "/search/search_index.json", "utf8"));
index.config.lang = ["en"];
hear[0]({data: {type: 0, data: {config: index.config, docs: index.docs, options: {pipeline: ["trimmer", "stopWordFilter"], suggestions: false}}}});

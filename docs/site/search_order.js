// SPDX-License-Identifier: MPL-2.0
// The order of the results of a search. Sphinx gives 15 to any page with a word of the search in a heading, and 5 to any
// other page with all words. Here pages that answer a question with these words come first, and generated pages last.
const searchQuestions = QUESTIONS_OF_THE_SITE;

// Words of questions that say nothing about their subject; a page need not have them.
["calculate", "can", "compute", "find", "get", "give", "make", "may", "need", "show", "use", "using", "want", "will", "would"]
  .forEach((word) => stopwords.add(word));

function searchOrder() {
  const stemmer = new Stemmer();
  const stems = (text) => new Set(
    text.toLowerCase().split(/[^\p{Letter}\p{Number}_]+/u)
      .filter((word) => word && !stopwords.has(word) && !/^\d+$/.test(word))
      .map((word) => stemmer.stemWord(word)));
  const asked = searchQuestions.map(([question, pages]) => [stems(question), pages]);
  const last = [[/^reference\/cpp/, 6], [/^reference\/python/, 4],
    [/^(accuracy|benchmarks|paper|design|questions|about\/changes|howto\/index|index)$/, 4]];
  let query, wanted;

  return ([name, title, anchor, , score, , kind]) => {
    const typed = new URLSearchParams(window.location.search).get("q") || "";
    if (typed !== query) [query, wanted] = [typed, [...stems(typed)]];
    const share = (words) => wanted.filter((word) => words.has(word)).length / Math.max(wanted.length, 1);
    if (kind === "index") score = 14 * score / 100; // a term of the glossary
    let order = score - (last.find(([pattern]) => pattern.test(name)) || [, 0])[1];
    order += 6 * Math.floor(share(stems(title)));
    if (kind === "text") {
      let answers = 0;
      asked.forEach(([words, pages], row) => { // the first link of a row before the others, earlier rows before later ones
        if (!wanted.length || !pages.includes(name)) return;
        const missing = Math.round(wanted.length * (1 - share(words)));
        const worth = missing === 0 ? 20 : missing < wanted.length / 2 ? 8 : -Infinity;
        answers = Math.max(answers, worth - 2 * pages.indexOf(name) + 4 * share(words) * wanted.length / words.size - row / 100);
      });
      order += answers;
    }
    return order;
  };
}

// If no page has all words: pages with all words that some page has; if there are none, pages with all of these but one.
if (typeof Search !== "undefined") {
  const pagesWithAll = Search.performTermsSearch;
  Search.performTermsSearch = (terms, excluded) => {
    const found = pagesWithAll(terms, excluded);
    if (found.length || terms.size < 2) return found;
    const known = [...terms].filter((term) => pagesWithAll(new Set([term]), new Set()).length);
    const some = pagesWithAll(new Set(known), excluded);
    if (some.length || known.length < 3) return some;
    return known.flatMap((left) => pagesWithAll(new Set(known.filter((term) => term !== left)), excluded));
  };
}

var Scorer = {
  score: (result) => (Scorer.order ??= searchOrder())(result),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: {0: 15, 1: 5, 2: -5},
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};

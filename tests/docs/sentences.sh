#!/usr/bin/env bash
# sentences.sh SOURCE_DIR [WORDS]: prints the length of the sentences of each group of texts, in words: median, 90th
# percentile and longest. Fails when a group's 90th percentile exceeds 30. With WORDS, lists every longer sentence.
#
# Left out are tables, code blocks, headings, HTML, the targets of links, and comments beside code: those are notes of a
# few words, and would make the rest look short. A sentence ends at a full stop, question mark or exclamation mark
# before a space; and with its paragraph, list item or comment. Consecutive // lines form one text, in which a list item
# begins at "- ", "1. " or three spaces.
set -euo pipefail
limit=30

# Each reads files, or standard input, and writes "file<tab>text" for every paragraph, item or comment.
# shellcheck disable=SC2120 # no file: standard input
texts_of_markdown() {
  awk '
    function flush() { if (text != "") print file "\t" text; text = "" }
    FNR == 1 { flush(); file = FILENAME; in_code = in_tag = 0 }
    /^ *```/ { flush(); in_code = !in_code; next }
    in_code { next }
    /^ *\|/ || /^#/ || /^ *$/ { flush(); next }
    in_tag { if (!sub(/^[^>]*>/, "")) next; in_tag = 0 }
    { gsub(/<[a-z!\/][^>]*>/, ""); in_tag = sub(/<[a-z!][^>]*$/, "") }
    /^ *[-*+] / || /^ *[0-9]+\. / { flush(); sub(/^ *([-*+]|[0-9]+\.) /, "") }
    { gsub(/\]\([^)]*\)/, "]"); text = text " " $0 }
    END { flush() }' "$@"
}

# shellcheck disable=SC2120
texts_of_comments() {
  awk '
    function flush() { if (text != "") print file "\t" text; text = ""; in_list = 0 }
    FNR == 1 { flush(); file = FILENAME; beside_code = 0 }
    {
      code = $0
      gsub(/"[^"]*"/, "\"\"", code)  # what stands in a string is no comment
      if (!match(code, /(^|[ \t])\/\//)) { flush(); beside_code = 0; next }
      comment = substr(code, RSTART + RLENGTH)
      if (substr(code, 1, RSTART) ~ /[^ \t\/]/) { flush(); beside_code = 1 }
      if (beside_code) next
      if (comment ~ /^ *$/) { flush(); next }
      if (comment ~ /^ *([-*]|[0-9]+\.) /) { flush(); in_list = 1; sub(/^ *([-*]|[0-9]+\.) /, "", comment) }
      else if (comment ~ /^   / && !in_list) flush()
      text = text " " comment
    }
    END { flush() }' "$@"
}

# Reads those lines; writes "words<tab>file<tab>sentence" for every sentence.
sentences() {
  awk -F '\t' '
    function finish() { if (words > 0) print words "\t" $1 "\t" sentence; words = 0; sentence = "" }
    {
      n = split($2, word, /[ \t]+/)
      for (i = 1; i <= n; ++i) {
        if (word[i] == "") continue
        sentence = sentence (sentence == "" ? "" : " ") word[i]
        if (word[i] ~ /[A-Za-z0-9]/) ++words
        if (word[i] ~ /^\.+[^.]*$/ || word[i] ~ /^[(]?(s|p|al|cf|vs|e\.g|i\.e)\.$/) continue
        if (word[i] ~ /[.!?][]"`*_)'"'"']*$/) finish()
      }
      finish()
    }'
}

# Reads those lines and prints "count median 90th longest".
figures() {
  cut -f1 | sort -n | awk '
    { words[NR] = $1 }
    function percentile(p) { rank = int((NR * p + 99) / 100); return words[rank < 1 ? 1 : rank] }
    END { print NR, percentile(50), percentile(90), words[NR] }'
}

# judge GROUP < sentences: prints the group's line; fails when its sentences are too long.
judge() {
  local count median ninetieth longest
  read -r count median ninetieth longest < <(figures)
  echo "$1: $count sentences, median $median, 90th percentile $ninetieth, longest $longest words"
  [[ $count -gt 0 && $ninetieth -le $limit ]]
}

# The control: in made-up texts every rule above must hold, and a sentence of 40 words must fail its group.
expect() {
  if [[ $2 != "$3" ]]; then
    echo "sentences.sh: self-check: $1: found '$2' instead of '$3'"
    exit 2
  fi
}
# shellcheck disable=SC2016,SC2119 # backquotes are meant; texts come from standard input
self_check() {
  local forty ten markdown comments found
  ten='one two three four five `six` seven (s. 8) nine'  # "(s." and "8)" are two words
  forty="$ten $ten $ten $ten"
  markdown="# A heading $forty
| a table | $forty |
\`\`\`sh
$forty
\`\`\`
<img alt=\"$forty
$forty\">
A [link](of/many/words.md) of four. Five words ... end, 100 %. And four are here

- Two items
- without a stop

${forty/five/five
}. End."
  comments="#include \"a//b\"
// $ten
// $ten
int a = 0;  // pixels
int b = 0;  // $ten
            // $ten

//   item $ten
//   item of two
// - $ten
//   $ten $ten $ten"
  found=$(texts_of_markdown <<<"$markdown" | sentences | cut -f1 | tr '\n' ' ')
  expect 'Markdown' "$found" '4 4 4 2 3 40 1 '
  found=$(texts_of_comments <<<"$comments" | sentences | cut -f1 | tr '\n' ' ')
  expect 'comments' "$found" '20 11 3 40 '
  if judge 'made up' < <(texts_of_markdown <<<"$forty" | sentences) >/dev/null; then
    echo 'sentences.sh: self-check: 40 words passed'
    exit 2
  fi
  judge 'made up' < <(texts_of_markdown <<<"$ten" | sentences) >/dev/null ||
    expect 'ten words' 'failed' 'passed'
}
self_check

cd "$1"
mapfile -t headers < <(find src -name '*.h' | sort)
scratch=$(mktemp)
trap 'rm -f "$scratch"' EXIT
failed=0
group() {  # NAME READER FILE...
  local name=$1 reader=$2
  shift 2
  "$reader" "$@" | sentences >"$scratch"
  judge "$name" <"$scratch" || failed=1
  if [[ -n $list ]]; then awk -F '\t' -v above="$list" '$1 > above + 0' "$scratch" | sort -rn; fi
}
list=${2:-}
group 'README.md' texts_of_markdown README.md
group 'CONTRIBUTING.md and the like' texts_of_markdown CONTRIBUTING.md SECURITY.md CODE_OF_CONDUCT.md
group 'docs/*.md' texts_of_markdown docs/*.md
group 'docs/decisions/*.md' texts_of_markdown docs/decisions/*.md
group 'comments of headers' texts_of_comments "${headers[@]}"
[[ $failed -eq 0 ]] || echo "too long: bash tests/docs/sentences.sh . $limit lists the longer ones"
exit $failed

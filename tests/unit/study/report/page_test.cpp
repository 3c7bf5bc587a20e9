#include "study/report/output.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "image/atomic_file.h"
#include "unit/image/temporary_directory.h"

namespace pprt::page_test {

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

}  // namespace

TEST_CASE("page: text cannot become markup") {
  CHECK(escape_html("<a href=\"x\">&</a>") == "&lt;a href=&quot;x&quot;&gt;&amp;&lt;/a&gt;");
  const std::string evil = "<script>alert(1)</script>";
  Page page(evil);
  page.heading(evil);
  page.paragraph(evil);
  page.note(evil);
  page.table({{evil}, {{evil}}});
  page.figure("<svg></svg>", evil);
  page.gallery(std::vector<Picture>{{evil, "png", ""}});
  const std::string html = page.html();
  CHECK(count(html, "<script") == 0);
  CHECK(count(html, "&lt;script&gt;") == 11);
}

TEST_CASE("page: bytes are encoded as base 64") {
  // The examples of RFC 4648, section 10.
  CHECK(to_base64("").empty());
  CHECK(to_base64("f") == "Zg==");
  CHECK(to_base64("fo") == "Zm8=");
  CHECK(to_base64("foo") == "Zm9v");
  CHECK(to_base64("foobar") == "Zm9vYmFy");
  CHECK(to_base64("\xff\xef\xbf") == "/++/");
}

TEST_CASE("page: its headings stand above it, each a way to its part") {
  Page page("A study");
  page.paragraph("first");
  page.heading("A & B");
  page.section("C", "text");
  const std::string html = page.html();
  CHECK(html.find("<nav>\n<a href=\"#part-1\">A &amp; B</a>\n<a href=\"#part-2\">C</a>\n</nav>") <
        html.find("<p>first</p>"));
  CHECK(count(html, "<h2 id=\"part-2\">C</h2>") == 1);
  CHECK(count(Page("Nothing").html(), "<nav>") == 0);
}

TEST_CASE("page: it needs no other file") {
  Page page("A study");
  page.gallery(std::vector<Picture>{{"a frame", "\x89PNG", ""}});
  page.table({{"finding", "measured"}, {{"one", 0.25}, {"two", 1.0}}, {Tone::kGood, Tone::kBad}});
  const std::string html = page.html();
  CHECK(count(html, "http") == 0);
  CHECK(count(html, "src=") == count(html, "src=\"data:image/png;base64,"));
  CHECK(count(html, "<tr class=\"good\"><td>one</td><td class=\"number\">0.25</td></tr>") == 1);
  CHECK(count(html, "<tr class=\"bad\">") == 1);
}

TEST_CASE("provenance: each fact of this machine has a value") {
  const Provenance facts = provenance_of_host();
  CHECK(facts.size() == 7);
  for (const auto& [name, value] : facts) {
    CAPTURE(name);
    CHECK_FALSE(value.empty());
  }
}

TEST_CASE("provenance: it stands above a CSV as comments of one line each, and ends the page") {
  CHECK(as_comments({{"host", "a"}, {"command", "b\nc"}}) == "# host: a\n# command: b c\n");
  const TemporaryDirectory directory;
  StudyOutput output(directory.path(), "A study", {{"seed", "a <1>"}});
  output.add_table("numbers", {{"x"}, {{1.5}}});
  output.finish();
  const std::string csv = read_whole_file(directory.path() / "numbers.csv");
  CHECK(csv.starts_with("# program: pprt-study "));
  CHECK(csv.find("\n# seed: a <1>\n# date: ") != std::string::npos);
  CHECK(csv.ends_with("\nx\n1.5\n"));
  const std::string html = read_whole_file(directory.path() / "index.html");
  CHECK(html.find("<h2 id=\"part-1\">Provenance</h2>") > html.find("<td class=\"number\">1.5</td>"));
  CHECK(count(html, "<td>seed</td><td>a &lt;1&gt;</td>") == 1);
  CHECK(read_whole_file(directory.path() / "provenance.json").find("\"seed\": \"a <1>\"") !=
        std::string::npos);
}

}  // namespace pprt::page_test

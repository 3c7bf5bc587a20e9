// A report as one HTML file, which needs neither network nor script.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/report/table.h"

namespace pprt {

// Escapes text for HTML elements and attributes.
std::string escape_html(std::string_view text);

// Encodes by RFC 4648, section 4.
std::string to_base64(std::string_view bytes);

struct Picture {
  std::string caption;
  std::string png;       // bytes of the file
  std::string file;      // name in the study's directory; empty: on the page only
  bool is_wide = false;  // takes a row of its own
};

// Collects a report from top to bottom, under a list of its headings. Escapes all text; takes SVG as it is.
class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);
  void section(std::string_view title, std::string_view text) { heading(title), paragraph(text); }
  void paragraph(std::string_view text) { element("p", "", text); }
  void note(std::string_view text) { element("p", " class=\"note\"", text); }  // highlighted
  void listing(std::string_view text) { element("pre", "", text); }            // keeps its lines, fixed pitch
  void table(const Table& table);
  void figure(std::string_view svg, std::string_view caption);
  void gallery(std::span<const Picture> pictures);

  // Returns the whole file.
  std::string html() const;

 private:
  void element(std::string_view tag, std::string_view attributes, std::string_view text);

  std::string contents() const;

  std::string title_;
  std::string body_;
  std::vector<std::string> headings_;
};

}  // namespace pprt

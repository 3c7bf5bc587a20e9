// A report to be read: one HTML file that needs nothing else, neither network nor script.
#pragma once

#include <string>
#include <string_view>

#include "study/report/provenance.h"
#include "study/report/table.h"

namespace pprt {

// Text for HTML, in elements and in attributes.
std::string escape_html(std::string_view text);

std::string to_base64(std::string_view bytes);

// Built from top to bottom. All text is escaped; an SVG is taken as it is.
class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);
  void paragraph(std::string_view text);
  void note(std::string_view text);     // stands out: something is missing
  void listing(std::string_view text);  // in lines of their own, letters of one width
  void table(const Table& table);
  void figure(std::string_view svg, std::string_view caption);
  void picture(std::string_view png, std::string_view caption);
  void begin_gallery();  // pictures up to end_gallery() stand beside each other
  void end_gallery();

  // The whole file; the provenance stands at its end.
  std::string html(const Provenance& provenance) const;

 private:
  std::string title_;
  std::string body_;
};

}  // namespace pprt

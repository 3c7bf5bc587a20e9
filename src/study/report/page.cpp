#include "study/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace pprt {
namespace {

constexpr std::string_view kStyle = R"css(
body { margin: 2rem auto; max-width: 62rem; padding: 0 1rem; color: #222; background: #fff;
       font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; border-bottom: 1px solid #ddd; }
table { border-collapse: collapse; font-size: 0.85rem; margin: 1rem 0; }
div.wide { overflow-x: auto; }
th, td { text-align: left; vertical-align: top; padding: 0.25rem 0.7rem; border-bottom: 1px solid #e4e4e4; }
th { border-bottom: 2px solid #bbb; } td.number { text-align: right; font-variant-numeric: tabular-nums; }
tr.good td:first-child { border-left: 4px solid #009e73; } tr.bad td:first-child { border-left: 4px solid #d55e00; }
figure { margin: 1rem 0; } figure svg { width: 100%; height: auto; }
figcaption { font-size: 0.85rem; color: #555; }
div.gallery { display: flex; flex-wrap: wrap; gap: 1rem; } div.gallery figure { margin: 0; width: 18.5rem; }
div.gallery img { width: 100%; } div.gallery figure.wide { width: 100%; }
figure img { max-width: 100%; image-rendering: pixelated; border: 1px solid #ddd; }
pre { background: #f6f6f6; padding: 0.6rem 0.9rem; font-size: 0.8rem; overflow-x: auto; }
nav { font-size: 0.85rem; columns: 18rem; border: 1px solid #e4e4e4; padding: 0.5rem 1rem; }
nav a { display: block; color: #0072b2; text-decoration: none; }
p.note { background: #fff4dd; border-left: 4px solid #e69f00; padding: 0.5rem 1rem; }
)css";

const char* class_of(const Table& table, std::size_t row) {
  const Tone tone = row < table.tones.size() ? table.tones[row] : Tone::kPlain;
  return tone == Tone::kGood ? " class=\"good\"" : tone == Tone::kBad ? " class=\"bad\"" : "";
}

std::string html_cell(const Cell& cell) {
  const bool is_text = std::holds_alternative<std::string>(cell);
  return fmt::format("<td{}>{}</td>", is_text ? "" : " class=\"number\"", escape_html(to_text(cell)));
}

}  // namespace

std::string escape_html(std::string_view text) {
  constexpr std::array<std::pair<char, std::string_view>, 4> kEntities = {
      {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}}};
  std::string escaped;
  for (const char c : text) {
    const auto* entity =
        std::find_if(kEntities.begin(), kEntities.end(), [c](const auto& e) { return e.first == c; });
    escaped += entity == kEntities.end() ? std::string_view(&c, 1) : entity->second;
  }
  return escaped;
}

std::string to_base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

void Page::heading(std::string_view text) {
  headings_.emplace_back(text);
  element("h2", fmt::format(" id=\"part-{}\"", headings_.size()), text);
}

std::string Page::contents() const {
  std::string list;
  for (std::size_t i = 0; i < headings_.size(); ++i)
    list += fmt::format("<a href=\"#part-{}\">{}</a>\n", i + 1, escape_html(headings_[i]));
  return list.empty() ? list : "<nav>\n" + list + "</nav>\n";
}

void Page::element(std::string_view tag, std::string_view attributes, std::string_view text) {
  body_ += fmt::format("<{0}{1}>{2}</{0}>\n", tag, attributes, escape_html(text));
}

void Page::table(const Table& table) {
  body_ += "<div class=\"wide\"><table>\n<thead><tr>";
  for (const std::string& name : table.columns) body_ += "<th>" + escape_html(name) + "</th>";
  body_ += "</tr></thead>\n<tbody>\n";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    body_ += fmt::format("<tr{}>", class_of(table, row));
    for (const Cell& cell : table.rows[row]) body_ += html_cell(cell);
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Page::figure(std::string_view svg, std::string_view caption) {
  body_ += fmt::format("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n", svg, escape_html(caption));
}

void Page::gallery(std::span<const Picture> pictures) {
  body_ += "<div class=\"gallery\">\n";
  for (const Picture& picture : pictures) {
    body_ += fmt::format(
        "<figure{2}><img alt=\"{0}\" "
        "src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        escape_html(picture.caption), to_base64(picture.png), picture.is_wide ? " class=\"wide\"" : "");
  }
  body_ += "</div>\n";
}

std::string Page::html() const {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style>\n"
      "</head>\n<body>\n<h1>{0}</h1>\n{2}{3}</body>\n</html>\n",
      escape_html(title_), kStyle, contents(), body_);
}

}  // namespace pprt

// SPDX-License-Identifier: MIT
#include "gallery/html.h"

#include <fmt/format.h>

#include <algorithm>

#include "text/quoting.h"

namespace ziggurat::gallery {
namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light dark; font: 15px/1.45 system-ui, sans-serif; }
body { margin: 0 auto; max-width: 1500px; padding: 20px; }
h1 { font-size: 20px; font-weight: 600; overflow-wrap: anywhere; }
main { display: grid; gap: 18px; grid-template-columns: repeat(auto-fill, minmax(270px, 1fr)); }
article { border: 1px solid #8884; border-radius: 8px; display: flex; flex-direction: column; overflow: hidden; }
img, .none { aspect-ratio: 16 / 9; width: 100%; display: grid; place-items: center; background: #8882; color: #888; }
h2 { font-size: 16px; margin: 10px 12px 0; overflow-wrap: anywhere; }
p { margin: 4px 12px 10px; overflow-wrap: anywhere; }
.run { align-self: flex-start; background: #3f74b3; border-radius: 5px; color: #fff; margin: auto 12px 12px;
       padding: 4px 16px; text-decoration: none; }
.run:hover, .run:focus { background: #2f5f98; }
)";

/// @param refresh  seconds until it asks again; 0: never
std::string page(std::string_view title, std::string_view body, int refresh) {
  const std::string again =
      refresh > 0 ? fmt::format("<meta http-equiv=\"refresh\" content=\"{}\">\n", refresh) : "";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src 'self' "
      "data:; "
      "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n{}"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>{}</style>\n{}</html>\n",
      again, title, style, body);
}

std::string picture_of(std::size_t number, Picture picture, const std::string& path) {
  if (picture == Picture::there)
    return fmt::format("<img src=\"{}picture/{}\" alt=\"\" loading=\"lazy\">", path, number);
  return fmt::format("<div class=\"none\">{}</div>",
                     picture == Picture::awaited ? "drawing …" : "no picture");
}

}  // namespace

std::string gallery_page(const std::string& folder, const std::vector<Scene>& scenes,
                         const std::vector<Picture>& pictures, const std::string& path) {
  const std::string title = text::html_text(folder);
  std::string body = fmt::format("<h1>Scenes of {}</h1>\n<main>\n", title);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    body += fmt::format(
        "<article>{}<h2>{}</h2><p>{}</p><a class=\"run\" href=\"{}run/{}\">Run</a></article>\n",
        picture_of(i, pictures[i], path), text::html_text(scenes[i].name),
        text::html_text(scenes[i].sentence), path, i);
  }
  const bool waits = std::ranges::find(pictures, Picture::awaited) != pictures.end();
  return page(title, body + "</main>\n", waits ? 3 : 0);
}

std::string notice_page(const std::string& sentence, const std::string& path, bool again) {
  return page("Ziggurat",
              fmt::format("<p>{}</p>\n<a class=\"run\" href=\"{}\">All scenes</a>\n",
                          text::html_text(sentence), path),
              again ? 1 : 0);
}

}  // namespace ziggurat::gallery

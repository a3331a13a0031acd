// SPDX-License-Identifier: MIT
#include "scene/malformed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ranges>
#include <utility>
#include <vector>

#include "scene/names.h"
#include "scene/values.h"
#include "text/shortened.h"

namespace ziggurat::scene {
namespace {

constexpr std::string_view white = " \t\r\n";
constexpr std::size_t npos = std::string_view::npos;

/// A word without the “curly” quotes of word processors around it.
std::string_view without_curly_quotes(std::string_view word) {
  constexpr std::string_view quotes[] = {"“", "”", "„", "‘", "’"};
  for (const std::string_view quote : quotes) {
    if (!word.starts_with(quote)) continue;
    word.remove_prefix(quote.size());
    break;
  }
  for (const std::string_view quote : quotes) {
    if (!word.ends_with(quote)) continue;
    word.remove_suffix(quote.size());
    break;
  }
  return word;
}

/// Whether one of the names is the other misspelt.
bool is_nearly(std::string_view a, std::string_view b) {
  const std::array candidates{b};
  return nearest(a, candidates).has_value();
}

/// Behind the document type that begins there; it may have tags, comments and texts of its own.
std::size_t end_of_document_type(std::string_view source, std::size_t at) {
  const auto behind = [&](std::string_view end, std::size_t from) {
    const std::size_t found = source.find(end, from);
    return found == npos ? npos : found + end.size();
  };
  for (int depth = 0; (at = source.find_first_of("<>\"'", at)) != npos;) {
    const std::string_view rest = source.substr(at);
    if (rest.starts_with("<!--")) {
      at = behind("-->", at + 4);
    } else if (rest.starts_with("<?")) {
      at = behind("?>", at + 2);
    } else if (rest[0] == '"' || rest[0] == '\'') {
      at = behind(rest.substr(0, 1), at + 1);
    } else {
      ++at;
      depth += rest[0] == '<' ? 1 : -1;
      if (depth == 0) return at;
    }
  }
  return npos;
}

/// Walks over the tags of a text until one is wrong.
class Scanner {
 public:
  explicit Scanner(std::string_view source) : source_(source) {}

  std::optional<Malformed> scan() {
    while (!found_ && next_tag()) tag();
    if (!found_ && !open_.empty()) fail(source_.find_last_not_of(white) + 1, unclosed());
    return std::move(found_);
  }

 private:
  struct Open {
    std::string_view name;
    std::size_t offset;
  };

  bool next_tag() {
    at_ = source_.find('<', at_);
    return at_ != npos;
  }

  void tag() {
    const std::string_view rest = source_.substr(at_);
    if (rest.starts_with("<!--")) return skip("-->", "this comment is not closed; end it with -->");
    if (rest.starts_with("<?")) return skip("?>", "this <? is not closed; end it with ?>");
    if (rest.starts_with("<![CDATA[")) {
      return skip("]]>", "this CDATA section is not closed; end it with ]]>");
    }
    if (rest.starts_with("<!")) {
      at_ = std::min(end_of_document_type(source_, at_), source_.size());
      return;
    }
    rest.starts_with("</") ? closing_tag() : opening_tag();
  }

  void skip(std::string_view end, const char* otherwise) {
    const std::size_t found = source_.find(end, at_);
    if (found == npos) return fail(at_, otherwise);
    at_ = found + end.size();
  }

  void closing_tag() {
    const std::size_t begin = at_;
    const std::size_t end = source_.find_first_of("<>", begin + 1);
    const std::string_view name = trimmed(source_.substr(begin + 2, end - begin - 2));
    if (end == npos || source_[end] == '<' || name.empty()) {
      return fail(begin, "this closing tag is malformed; write </name>");
    }
    at_ = end + 1;
    if (open_.empty()) {
      return fail(begin, fmt::format("</{}> closes nothing: no element is open here; remove it",
                                     text::shortened(name)));
    }
    const Open last = open_.back();
    open_.pop_back();
    if (last.name == name) return;
    const bool is_outer = std::ranges::find(open_, name, &Open::name) != open_.end();
    if (is_outer) {
      return fail(last.offset,
                  fmt::format("<{0}> is not closed before </{1}> at line {2}; write </{0}>, "
                              "or /> at the end of <{0} …> if nothing is in it",
                              last.name, name, line_of(begin)));
    }
    fail(begin, fmt::format("</{0}> does not close <{1}> of line {2}; write </{1}>{3}",
                            text::shortened(name), last.name, line_of(last.offset),
                            is_nearly(name, last.name) ? fmt::format(", or <{}> there", name)
                                                       : std::string()));
  }

  void opening_tag() {
    const std::size_t begin = at_++;
    const std::string_view name = word();
    if (name.empty() || std::string_view("-.0123456789").find(name[0]) != npos) {
      return fail(begin, "this is no element; write &lt; for a literal <");
    }
    while (!found_) {
      skip_white();
      if (source_.substr(at_).starts_with("/>")) return advance(2);
      if (next() == '>') {
        open_.push_back({name, begin});
        return advance(1);
      }
      if (next() == '\0') return fail_at_end(name, begin);
      if (next() == '<' || next() == '/') {
        return fail(begin, fmt::format("the tag <{}> is not finished; write > or /> behind its "
                                       "attributes",
                                       name));
      }
      attribute(name);
    }
  }

  void attribute(std::string_view element) {
    const std::size_t begin = at_;
    const std::string_view name = word();
    if (name.empty()) {
      return fail(begin, fmt::format("{} is no attribute of <{}>; write name=\"value\"",
                                     in_quotes(source_.substr(begin, 1)), element));
    }
    skip_white();
    if (next() == '\0') return fail_at_end(element, begin);
    if (next() != '=') {
      return fail(begin, fmt::format("the attribute {0} of <{1}> has no value; write {0}=\"…\"",
                                     name, element));
    }
    advance(1);
    skip_white();
    value(name, element);
  }

  void value(std::string_view name, std::string_view element) {
    const std::size_t begin = at_;
    const char quote = next();
    if (quote == '\0') return fail_at_end(element, begin);
    if (quote != '"' && quote != '\'') {
      const std::size_t end = source_.find_first_of(" \t\r\n\"'/<>", begin);
      const std::string_view word = source_.substr(begin, std::min(end, begin + 60) - begin);
      const std::string_view bare = without_curly_quotes(word);
      return fail(
          begin,
          fmt::format("the value of {0} in <{1}> has {3}; write {0}=\"{2}\"", name, element, bare,
                      bare == word ? "no quotes" : "curly quotes, which are none in XML"));
    }
    const std::size_t end = source_.find(quote, begin + 1);
    const std::string_view text = source_.substr(begin + 1, end - begin - 1);
    at_ = end == npos ? source_.size() : end + 1;
    const bool ends_well = end != npos && (white.find(next()) != npos || next() == '/' ||
                                           next() == '>' || next() == '?' || next() == '\0');
    if (ends_well) return;
    const bool runs_on = end == npos || text.find('<') != npos || trimmed(text).ends_with('=');
    if (runs_on) {
      return fail(begin,
                  fmt::format("the value of {0} in <{1}> has no closing quote; write {2} behind "
                              "it, as in {0}={2}…{2}",
                              name, element, quote));
    }
    fail(at_, fmt::format("{} stands directly behind the value of {} in <{}>; write a space in "
                          "between, or one quote less",
                          in_quotes(source_.substr(at_, 1)), name, element));
  }

  void fail_at_end(std::string_view element, std::size_t offset) {
    fail(source_.size(),
         fmt::format("the file ends too early, in the tag <{}> of line {}; complete it, "
                     "and close every element that was opened",
                     element, line_of(offset)));
  }

  std::string unclosed() const {
    const Open& last = open_.back();
    return fmt::format(
        "the file ends too early; close every element that was opened, first <{}> of "
        "line {}",
        last.name, line_of(last.offset));
  }

  std::string_view word() {
    const std::size_t begin = at_;
    at_ = std::min(source_.find_first_of(" \t\r\n=\"'/<>", at_), source_.size());
    return source_.substr(begin, at_ - begin);
  }
  void skip_white() { at_ = std::min(source_.find_first_not_of(white, at_), source_.size()); }
  char next() const { return at_ < source_.size() ? source_[at_] : '\0'; }
  void advance(std::size_t count) { at_ += count; }
  std::ptrdiff_t line_of(std::size_t offset) const {
    std::ptrdiff_t line = 1;
    for (std::size_t i = 0; i < offset; ++i) line += ends_line(source_, i) ? 1 : 0;
    return line;
  }
  void fail(std::size_t offset, std::string text) { found_ = Malformed{offset, std::move(text)}; }

  std::string_view source_;
  std::size_t at_ = 0;
  std::vector<Open> open_;
  std::optional<Malformed> found_;
};

/// Behind the tag that begins there.
std::size_t end_of_tag(std::string_view source, std::size_t at, std::optional<Malformed>& fault) {
  while ((at = source.find_first_of("\"'>", at)) != npos && source[at] != '>') {
    const std::size_t begin = at + 1, end = source.find(source[at], begin);
    if (end == npos) return npos;
    const std::size_t literal = source.substr(begin, end - begin).find('<');
    if (!fault && literal != npos)
      fault = Malformed{begin + literal, "< inside a value; write &lt; for a literal <"};
    at = end + 1;
  }
  return at;
}

/// Whether an instruction is the XML declaration; XML keeps the name in upper case for itself, too.
bool is_declaration(std::string_view instruction) {
  const std::string_view name = instruction.substr(2, instruction.find_first_of(" \t\r\n?", 2) - 2);
  return name.size() == 3 && (name[0] | 32) == 'x' && (name[1] | 32) == 'm' &&
         (name[2] | 32) == 'l';
}

}  // namespace

Unescaped find_unescaped(std::string_view source) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::size_t start = source.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  Unescaped found;
  for (std::size_t at = source.find('<'); at != npos; at = source.find('<', at)) {
    const std::string_view rest = source.substr(at);
    if (rest.starts_with("<!--")) {
      const std::size_t dashes = source.find("--", at + 4), end = source.find("-->", at + 4);
      if (dashes < end && !found.dashes) found.dashes = dashes;
      at = end;
    } else if (rest.starts_with("<![CDATA[")) {
      at = source.find("]]>", at);
    } else if (rest.starts_with("<?")) {
      if (at > start && !found.declaration && is_declaration(rest)) found.declaration = at;
      at = source.find("?>", at);
    } else if (rest.starts_with("<!")) {
      at = end_of_document_type(source, at);
    } else {
      at = end_of_tag(source, at, found.fault);
    }
  }
  return found;
}

std::optional<Malformed> find_malformed(std::string_view source) { return Scanner(source).scan(); }

}  // namespace ziggurat::scene

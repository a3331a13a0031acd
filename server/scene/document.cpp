// SPDX-License-Identifier: MIT
#include "scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "scene/malformed.h"
#include "scene/values.h"

namespace ziggurat::scene {
namespace {

constexpr std::size_t smallest_average_element = 32;  // [bytes], with its closing tag
constexpr std::size_t of_set_attribute =
    64;  // of an attribute that a setting sets, beside its value
constexpr std::size_t most_attributes = 100'000;  // of an element

/// The offset of the first byte that is not well-formed UTF-8, or npos.
std::size_t first_bad_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char lead = byte(i);
    const std::size_t size = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
    if (size == 0 || size > text.size() - i) return i;
    for (std::size_t k = 1; k < size; ++k) {
      if ((byte(i + k) & 0xC0) != 0x80) return i;
    }
    if (size > 2) {
      const unsigned char second = byte(i + 1);
      if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
          (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) {
        return i;
      }
    }
    i += size;
  }
  return std::string_view::npos;
}

/// Encodings that the parser reads: what is not ASCII must be UTF-8.
constexpr std::array<std::string_view, 6> known_encodings{"utf-8", "utf8",       "us-ascii",
                                                          "ascii", "iso-8859-1", "latin1"};

/// The encoding that the declaration of a text names, a part of it; empty if it names none.
std::string_view declared_encoding(std::string_view source) {
  const std::string_view declaration = source.substr(0, source.find("?>"));
  const std::size_t begin = declaration.find_first_of('<');
  if (begin == declaration.npos || !declaration.substr(begin).starts_with("<?xml")) return {};
  const std::size_t name = declaration.find("encoding", begin);
  const std::size_t quote = declaration.find_first_of("\"'", name);
  if (name == declaration.npos || quote == declaration.npos) return {};
  const std::size_t end = declaration.find(declaration[quote], quote + 1);
  return declaration.substr(quote + 1, end == declaration.npos ? 0 : end - quote - 1);
}

bool is_known_encoding(std::string_view name) {
  const auto is_same = [](char a, char b) {
    return a == (b >= 'A' && b <= 'Z' ? b + ('a' - 'A') : b);
  };
  return std::ranges::any_of(known_encodings, [&](std::string_view known) {
    return std::ranges::equal(known, name, is_same);
  });
}

/// The fault for an error of the parser.
std::string complaint(const pugi::xml_parse_result& result, bool at_end) {
  if (at_end) return "the file ends too early; close every element that was opened";
  switch (result.status) {
    case pugi::status_no_document_element:
      return "there is no element; write <argos-configuration> … </argos-configuration>";
    case pugi::status_unrecognized_tag:
    case pugi::status_bad_start_element:
      return "this is no element; write &lt; for a literal <";
    case pugi::status_bad_attribute:
      return "this attribute is malformed; write name=\"value\"";
    case pugi::status_bad_end_element:
      return "this closing tag is malformed; write </name>";
    case pugi::status_end_element_mismatch:
      return "this closing tag closes nothing that is open here; close elements in reverse order "
             "of opening";
    case pugi::status_bad_comment:
      return "this comment is not closed; end it with -->";
    case pugi::status_bad_pi:
      return "this <? is not closed; end it with ?>";
    case pugi::status_bad_cdata:
      return "this CDATA section is not closed; end it with ]]>";
    case pugi::status_bad_doctype:
      return "this document type declaration is malformed; remove it";
    default:
      return result.description();
  }
}

}  // namespace

ReadBudget budget_for(std::size_t max_size) {
  return {max_size, 2 * std::max<std::size_t>(1'000'000, max_size / smallest_average_element),
          most_attributes, false};
}

Document::Document(std::string text, std::size_t file, bool lenient, ReadBudget& budget,
                   Report& report, const Parameters* parameters, Vocabulary* vocabulary)
    : source_(std::move(text)),
      file_(file),
      lenient_(lenient),
      budget_(budget),
      report_(report),
      parameters_(parameters),
      vocabulary_(vocabulary) {
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < source_.size(); ++i) {
    if (ends_line(source_, i)) line_starts_.push_back(i + 1);
  }
  if (check_text()) parse();
}

bool Document::check_text() {
  budget_.bytes -= source_.size();
  if (trimmed(source_).empty()) {
    report_.fault({file_, 0, 0}, "the file is empty; a scene begins with <argos-configuration>");
    return false;
  }
  const auto tags = static_cast<std::size_t>(std::count(source_.begin(), source_.end(), '<'));
  if (tags > budget_.tags) {
    report_.fault({file_, 0, 0},
                  fmt::format("the file has more than {} elements; split the scene, or raise "
                              "--max-scene-size",
                              budget_.tags / 2));
    return false;
  }
  budget_.tags -= tags;
  if (const std::size_t nul = source_.find('\0'); nul != std::string::npos) {
    const bool is_recording = source_.starts_with("\x89MCAP0\r\n");
    report_.fault(at(nul), is_recording
                               ? "this is a recording, not a scene; 'ziggurat replay' repeats it"
                               : "this is binary data, not a scene; write an XML file in UTF-8");
    return false;
  }
  if (const std::size_t bad = first_bad_utf8(source_); bad != std::string_view::npos) {
    report_.fault(at(bad), "this is not UTF-8; save the file in UTF-8");
    return false;
  }
  if (const auto encoding = declared_encoding(source_);
      !encoding.empty() && !is_known_encoding(encoding)) {
    report_.fault(
        at(static_cast<std::size_t>(encoding.data() - source_.data())),
        fmt::format("encoding={} is not read; save the file in UTF-8 and write encoding=\"UTF-8\"",
                    in_quotes(encoding)));
    return false;
  }
  return true;
}

void Document::parse() {
  buffer_ = source_;
  constexpr unsigned options = pugi::parse_default | pugi::parse_doctype;
  const pugi::xml_parse_result result =
      tree_.load_buffer_inplace(buffer_.data(), buffer_.size(), options, pugi::encoding_utf8);
  check_doctype();
  if (!result) {
    if (const auto mistake = find_malformed(source_)) {
      report_.fault(at(mistake->offset), "malformed XML: " + mistake->text);
      return;
    }
    const auto offset = std::min(
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)), source_.size());
    const bool at_end = trimmed(std::string_view(source_).substr(offset)).empty() &&
                        result.status != pugi::status_no_document_element;
    report_.fault(at(offset), "malformed XML: " + complaint(result, at_end));
    return;
  }
  const Unescaped unescaped = find_unescaped(source_);
  if (unescaped.fault)
    report_.fault(at(unescaped.fault->offset), "malformed XML: " + unescaped.fault->text);
  if (unescaped.dashes) {
    report_.warn(
        at(*unescaped.dashes), "dashes",
        "-- inside a comment, which other programs that read XML refuse; write it without");
  }
  if (unescaped.declaration) {
    report_.warn(at(*unescaped.declaration), "declaration",
                 "<?xml … ?> behind the beginning of the file, which other programs that read XML "
                 "refuse; let the file "
                 "begin with it, or remove it");
  }
  check_outside();
  if (!check_attributes(budget_.attributes)) return;
  root_ = tree_.document_element();
  for (pugi::xml_node node = root_.next_sibling(); node; node = node.next_sibling()) {
    if (node.type() != pugi::node_element) continue;
    report_.fault(locate(node.name() - 1),
                  fmt::format("a second root element, <{}>; a file has one", node.name()));
  }
}

bool Document::check_attributes(std::size_t most) const {
  struct Search : pugi::xml_tree_walker {
    explicit Search(std::size_t most) : most(most) {}
    const std::size_t most;
    pugi::xml_node found;
    bool for_each(pugi::xml_node& node) override {
      const auto attributes = node.attributes();
      if (static_cast<std::size_t>(std::distance(attributes.begin(), attributes.end())) <= most)
        return true;
      found = node;
      return false;
    }
  } search(most);
  pugi::xml_node all = tree_;
  all.traverse(search);
  if (!search.found) return true;
  report_.fault(
      locate(search.found.name() - 1),
      fmt::format("<{}> has more than {} attributes; write fewer", search.found.name(), most));
  return false;
}

void Document::check_outside() {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::string_view source = source_;
  const std::size_t start = source.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  const std::size_t first = source.find('<'), behind = source.rfind('>') + 1;
  const auto check = [&](std::size_t offset, std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return;
    report_.warn(at(offset + begin), "outside",
                 "text outside of the root element has no effect, and other programs that read XML "
                 "refuse it; remove it");
  };
  check(start, source.substr(start, first - start));
  check(behind, source.substr(behind));
}

void Document::check_doctype() {
  for (const pugi::xml_node node : tree_.children()) {
    if (node.type() != pugi::node_doctype) continue;
    const bool entities = std::string_view(node.value()).find("<!ENTITY") != std::string_view::npos;
    if (entities) {
      report_.fault(
          locate(node.value()),
          "the document type declares entities, which are never expanded here; write the text "
          "itself");
    } else {
      report_.notice(locate(node.value()), "the document type declaration has no effect here");
    }
  }
}

Location Document::at(std::size_t offset) const {
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto line = static_cast<std::size_t>(next - line_starts_.begin());
  return {file_, static_cast<unsigned>(line),
          static_cast<unsigned>(offset - line_starts_[line - 1] + 1)};
}

Location Document::locate(const char* character) const {
  return at(static_cast<std::size_t>(character - buffer_.data()));
}

Location Document::locate(const pugi::xml_attribute& attribute) const {
  const auto found = set_.find(attribute.hash_value());
  return found == set_.end() ? locate(attribute.name()) : found->second.where;
}

Location Document::locate_value(const pugi::xml_attribute& attribute) const {
  if (const auto found = set_.find(attribute.hash_value()); found != set_.end()) {
    return found->second.where;
  }
  const std::string_view written = raw(attribute);
  const std::string_view text = trimmed(written);
  const std::ptrdiff_t skipped = text.empty() ? 0 : text.data() - written.data();
  return locate(attribute.value() + skipped);
}

Value<std::size_t> Document::set(const Setting& setting) {
  if (!root_) return std::size_t{0};
  if (budget_.bytes < of_set_attribute)
    return Wrong{"is one too many: the scene is too large; raise --max-scene-size"};
  auto found = attributes_at(root_, setting.path);
  if (const Wrong* wrong = std::get_if<1>(&found)) return *wrong;
  const std::size_t size = std::get<0>(found).size() * (of_set_attribute + setting.value.size());
  if (size > budget_.bytes) {
    budget_.bytes = 0;
    return Wrong{fmt::format(
        "matches {} attributes, with whose values the scene is too large; name fewer, or raise "
        "--max-scene-size",
        std::get<0>(found).size())};
  }
  budget_.bytes -= size;
  for (Attribute& each : std::get<0>(found)) {
    each.attribute.set_value(setting.value.c_str());
    set_.insert_or_assign(each.attribute.hash_value(),
                          Set{&setting, locate(each.element.name() - 1)});
  }
  return std::get<0>(found).size();
}

const Setting* Document::setting_of(const pugi::xml_attribute& attribute) const {
  const auto found = set_.find(attribute.hash_value());
  return found == set_.end() ? nullptr : found->second.setting;
}

std::string Document::origin(const pugi::xml_attribute& attribute) const {
  std::string text;
  if (std::string_view(attribute.value()).find("${") != std::string_view::npos) {
    if (const auto meant = value(attribute); const std::string* known = std::get_if<0>(&meant)) {
      text = fmt::format("; with its parameters it is {}", in_quotes(*known));
    }
  }
  if (const Setting* setting = setting_of(attribute)) text += "; set by " + to_string(*setting);
  return text;
}

Value<std::string> Document::value(const pugi::xml_attribute& attribute) const {
  const std::string_view text = trimmed(attribute.value());
  if (parameters_ == nullptr || text.find("${") == std::string_view::npos) return std::string(text);
  const Wrong too_large{
      "makes the scene too large, with its parameters written out; use shorter values, or raise "
      "--max-scene-size"};
  if (budget_.is_spent) return too_large;
  auto expanded = expand(text, *parameters_);
  const std::string* result = std::get_if<std::string>(&expanded);
  if (result == nullptr) return expanded;
  const std::size_t more = result->size() - std::min(result->size(), text.size());
  budget_.is_spent = more > budget_.bytes;
  if (budget_.is_spent) return too_large;
  budget_.bytes -= more;
  return expanded;
}

std::string_view Document::raw(const pugi::xml_attribute& attribute) const {
  const auto begin = static_cast<std::size_t>(attribute.value() - buffer_.data());
  return std::string_view(source_).substr(begin, source_.find(source_[begin - 1], begin) - begin);
}

}  // namespace ziggurat::scene

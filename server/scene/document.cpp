#include "scene/document.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <iterator>
#include <system_error>
#include <utility>

#include "scene/malformed.h"

namespace ziggurat::scene {
namespace {

constexpr std::size_t smallest_average_element = 32;  // [bytes], with its closing tag

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

/// Faults the first character reference of an attribute that stands for no character.
void check_references(const Document& document, std::string_view element,
                      const pugi::xml_attribute& attribute) {
  if (document.setting_of(attribute)) return;
  const std::string_view raw = document.raw(attribute);
  for (std::size_t begin = raw.find('&'); begin != std::string_view::npos;
       begin = raw.find('&', begin + 1)) {
    const std::size_t end = raw.find(';', begin);
    const std::string_view name =
        end == std::string_view::npos ? "" : raw.substr(begin + 1, end - begin - 1);
    constexpr std::string_view known[] = {"amp", "lt", "gt", "quot", "apos"};
    if (std::find(std::begin(known), std::end(known), name) != std::end(known)) continue;
    unsigned code = 0;
    if (name.starts_with('#')) {
      const bool hexadecimal = name.size() > 1 && name[1] == 'x';
      const std::string_view digits = name.substr(hexadecimal ? 2 : 1);
      const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code,
                                                 hexadecimal ? 16 : 10);
      if (error != std::errc() || stop != digits.data() + digits.size()) code = 0;
    }
    const bool white = code == 0x9 || code == 0xA || code == 0xD;
    const bool character = (code >= 0x20 && code <= 0x10FFFF && !(code >= 0xD800 && code < 0xE000));
    if (white || character) continue;
    document.report().fault(document.locate(attribute.value()),
                            fmt::format("{}={} of <{}> has the reference {}, which stands for no "
                                        "character; write &amp; for a literal &",
                                        attribute.name(), in_quotes(raw), element,
                                        in_quotes(raw.substr(begin, name.size() + 2))));
    return;
  }
}

void check_repeated_attributes(const Document& document, const pugi::xml_node& node) {
  std::vector<std::pair<std::string_view, const char*>> names;
  for (const pugi::xml_attribute attribute : node.attributes()) {
    names.emplace_back(attribute.name(), attribute.name());
  }
  std::sort(names.begin(), names.end());
  for (std::size_t i = 1; i < names.size(); ++i) {
    if (names[i].first != names[i - 1].first) continue;
    document.report().fault(
        document.locate(names[i].second),
        fmt::format("malformed XML: <{}> has the attribute {} twice; write it once", node.name(),
                    in_quotes(names[i].first)));
  }
}

/// @param known  the attributes that the element may have
void report_unknown_attribute(const Document& document, std::string_view element,
                              const pugi::xml_attribute& attribute,
                              std::span<const std::string_view> known, std::string_view elsewhere) {
  const Location where = document.locate(attribute);
  const std::string_view name = attribute.name();
  if (!elsewhere.empty()) {
    document.report().fault(where,
                            fmt::format("the attribute {}={} can't stand in this <{}>: {}", name,
                                        in_quotes(attribute.value()), element, elsewhere));
    return;
  }
  if (document.lenient()) {
    document.report().notice(where, fmt::format("unknown attribute {} of <{}> has no effect; {}",
                                                in_quotes(name), element, advice(name, known)));
    return;
  }
  if (const auto why = unsupported_attribute(name)) {
    document.report().fault(where, fmt::format("the attribute {}={} of <{}> is not supported; {}",
                                               name, in_quotes(attribute.value()), element, *why));
    return;
  }
  document.report().fault(where,
                          fmt::format("<{}> has an unknown attribute {}={}; {}{}", element, name,
                                      in_quotes(attribute.value()), advice(name, known),
                                      document.origin(attribute)));
  if (const auto meant = nearest(name, known)) document.report().left_out(*meant);
}

}  // namespace

ReadBudget budget_for(std::size_t max_size) {
  return {max_size, 2 * std::max<std::size_t>(1'000'000, max_size / smallest_average_element)};
}

Document::Document(std::string text, std::size_t file, bool lenient, ReadBudget& budget,
                   Report& report, const Parameters* parameters)
    : source_(std::move(text)),
      file_(file),
      lenient_(lenient),
      report_(report),
      parameters_(parameters) {
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < source_.size(); ++i) {
    if (source_[i] == '\n') line_starts_.push_back(i + 1);
  }
  if (check_text(budget)) parse();
}

bool Document::check_text(ReadBudget& budget) {
  budget.bytes -= source_.size();
  if (trimmed(source_).empty()) {
    report_.fault({file_, 0, 0}, "the file is empty; a scene begins with <argos-configuration>");
    return false;
  }
  const auto tags = static_cast<std::size_t>(std::count(source_.begin(), source_.end(), '<'));
  if (tags > budget.tags) {
    report_.fault({file_, 0, 0},
                  fmt::format("the file has more than {} elements; split the scene, or raise "
                              "--max-scene-size",
                              budget.tags / 2));
    return false;
  }
  budget.tags -= tags;
  if (const std::size_t nul = source_.find('\0'); nul != std::string::npos) {
    report_.fault(at(nul), "this is binary data, not a scene; write an XML file in UTF-8");
    return false;
  }
  if (const std::size_t bad = first_bad_utf8(source_); bad != std::string_view::npos) {
    report_.fault(at(bad), "this is not UTF-8; save the file in UTF-8");
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
  root_ = tree_.document_element();
  for (pugi::xml_node node = root_.next_sibling(); node; node = node.next_sibling()) {
    if (node.type() != pugi::node_element) continue;
    report_.fault(locate(node.name() - 1),
                  fmt::format("a second root element, <{}>; a file has one", node.name()));
  }
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
  auto found = attributes_at(root_, setting.path);
  if (const Wrong* wrong = std::get_if<1>(&found)) return *wrong;
  for (Attribute& each : std::get<0>(found)) {
    each.attribute.set_value(setting.value.c_str());
    set_.insert_or_assign(each.attribute.hash_value(),
                          Set{setting, locate(each.element.name() - 1)});
  }
  return std::get<0>(found).size();
}

const Setting* Document::setting_of(const pugi::xml_attribute& attribute) const {
  const auto found = set_.find(attribute.hash_value());
  return found == set_.end() ? nullptr : &found->second.setting;
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
  return expand(text, *parameters_);
}

std::string_view Document::raw(const pugi::xml_attribute& attribute) const {
  const auto begin = static_cast<std::size_t>(attribute.value() - buffer_.data());
  return std::string_view(source_).substr(begin, source_.find(source_[begin - 1], begin) - begin);
}

// --- Element ------------------------------------------------------------------------------------

Location Element::where() const { return document_->locate(node_.name() - 1); }

Location Element::where(const char* attribute) const {
  const pugi::xml_attribute found = node_.attribute(attribute);
  return found.empty() ? where() : document_->locate_value(found);
}

std::optional<std::string> Element::take(const char* attribute) {
  asked_attributes_.push_back(attribute);
  const pugi::xml_attribute found = node_.attribute(attribute);
  if (found.empty()) return std::nullopt;
  check_references(*document_, name(), found);
  auto value = document_->value(found);
  if (const Wrong* wrong = std::get_if<1>(&value)) {
    fault_at(attribute, wrong->text);
    return std::nullopt;
  }
  return std::get<0>(std::move(value));
}

std::vector<std::pair<std::string, std::string>> Element::all_attributes() {
  any_attribute_ = true;
  std::vector<std::pair<std::string, std::string>> result;
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (auto value = take(attribute.name())) {
      result.emplace_back(attribute.name(), std::move(*value));
    }
  }
  return result;
}

std::optional<Element> Element::child(const char* name) {
  asked_children_.push_back(name);
  const pugi::xml_node found = node_.child(name);
  if (!found) return std::nullopt;
  if (const pugi::xml_node second = found.next_sibling(name)) {
    report().notice(document_->locate(second.name() - 1),
                    fmt::format("a second <{}> in <{}> has no effect: the first one counts", name,
                                this->name()));
  }
  return Element(*document_, found);
}

std::optional<Element> Element::required_child(const char* name) {
  std::optional<Element> found = child(name);
  if (!found) fault(fmt::format("lacks the element <{0}>; write <{0} …> in it", name), {name});
  return found;
}

std::vector<Element> Element::children() {
  any_child_ = true;
  std::vector<Element> result;
  for (const pugi::xml_node node : node_.children()) {
    if (node.type() == pugi::node_element) result.emplace_back(*document_, node);
  }
  return result;
}

std::vector<Element> Element::children(const char* name) {
  asked_children_.push_back(name);
  std::vector<Element> result;
  for (const pugi::xml_node node : node_.children(name)) result.emplace_back(*document_, node);
  return result;
}

void Element::child_without_effect(const char* name, std::string_view why) {
  asked_children_.push_back(name);
  if (const pugi::xml_node found = node_.child(name)) {
    report().notice(document_->locate(found.name() - 1),
                    fmt::format("<{}> has no effect here: {}", name, why));
  }
}

void Element::done(std::string_view elsewhere) {
  check_repeated_attributes(*document_, node_);
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (any_attribute_) break;
    const std::string_view name = attribute.name();
    if (name.starts_with("xml:") || name.starts_with("xmlns")) continue;  // XML's own
    if (std::find(asked_attributes_.begin(), asked_attributes_.end(), name) ==
        asked_attributes_.end()) {
      report_unknown_attribute(*document_, this->name(), attribute, asked_attributes_, elsewhere);
    }
  }
  for (const pugi::xml_node node : node_.children()) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
      report().notice(document_->locate(node.value()),
                      fmt::format("the text {} in <{}> has no effect here",
                                  in_quotes(trimmed(node.value())), name()));
    }
    if (node.type() != pugi::node_element || any_child_) continue;
    if (std::find(asked_children_.begin(), asked_children_.end(), node.name()) ==
        asked_children_.end()) {
      const Element child(*document_, node);
      if (elsewhere.empty()) {
        child.unknown_in(name(), asked_children_);
      } else {
        child.fault(fmt::format("can't stand in this <{}>: {}", name(), elsewhere));
      }
    }
  }
}

void Element::unknown_in(std::string_view parent, std::span<const std::string_view> known) const {
  if (const auto why = unsupported_element(name())) {
    report().fault(where(), fmt::format("<{}> is not supported; {}", name(), *why));
    return;
  }
  const auto meant = nearest(name(), known);
  if (const auto home = home_of(name()); home && *home != parent && !meant) {
    report().fault(where(), fmt::format("<{}> can't stand in <{}>; write it into <{}>", name(), parent,
                                        *home));
    report().left_out(*home);
    report().left_out(name());
    return;
  }
  report().fault(where(), known.empty()
                              ? fmt::format("unknown element <{}> in <{}>, which has no elements",
                                            name(), parent)
                              : fmt::format("unknown element <{}> in <{}>; {}", name(), parent,
                                            advice(name(), known)));
  if (meant) report().left_out(*meant);
}

std::string Element::sentence(const char* attribute, std::string_view text) const {
  const pugi::xml_attribute found = node_.attribute(attribute);
  return fmt::format("{}={} of <{}> {}{}", attribute, in_quotes(trimmed(found.value())), name(), text,
                     document_->origin(found));
}

void Element::fault_at(const char* attribute, std::string_view text,
                       std::vector<std::string_view> causes) const {
  report().fault(where(attribute), sentence(attribute, text), std::move(causes));
}

void Element::fault(std::string_view text, std::vector<std::string_view> causes) const {
  report().fault(where(), fmt::format("<{}> {}", name(), text), std::move(causes));
}

void Element::missing(const char* attribute) const {
  fault(fmt::format("lacks the attribute {0}; write {0}=\"…\"", attribute), {attribute});
}

std::size_t Element::size() const {
  struct Sum : pugi::xml_tree_walker {
    std::size_t bytes = 0;
    void add(const pugi::xml_node& node) {
      bytes += 2 * std::string_view(node.name()).size() + std::string_view(node.value()).size();
      bytes += std::string_view("<></>").size();
      for (const pugi::xml_attribute attribute : node.attributes()) {
        bytes += std::string_view(attribute.name()).size();
        bytes += std::string_view(attribute.value()).size() + std::string_view(" =\"\"").size();
      }
    }
    bool begin(pugi::xml_node& node) override { return add(node), true; }
    bool for_each(pugi::xml_node& node) override { return add(node), true; }
  } sum;
  pugi::xml_node node = node_;
  node.traverse(sum);
  return sum.bytes;
}

}  // namespace ziggurat::scene

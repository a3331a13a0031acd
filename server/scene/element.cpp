// SPDX-License-Identifier: MIT
#include "scene/element.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <system_error>

#include "scene/old_words.h"

namespace ziggurat::scene {
namespace {

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

/// `name="value" of <element> <text>`.
std::string sentence_on(const Document& document, std::string_view element, std::string_view name,
                        const pugi::xml_attribute& attribute, std::string_view text) {
  return fmt::format("{}={} of <{}> {}{}", name, in_quotes(trimmed(attribute.value())), element,
                     text, document.origin(attribute));
}

/// The attribute's value; nothing, after a fault, if it has none.
std::optional<std::string> take_value(const Document& document, std::string_view element,
                                      const pugi::xml_attribute& attribute) {
  check_references(document, element, attribute);
  auto value = document.value(attribute);
  if (const Wrong* wrong = std::get_if<1>(&value)) {
    document.report().fault(
        document.locate_value(attribute),
        sentence_on(document, element, attribute.name(), attribute, wrong->text));
    return std::nullopt;
  }
  return std::get<0>(std::move(value));
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

/// The attribute, under its name or an old one.
/// @param home  the element's name
pugi::xml_attribute find(const pugi::xml_node& node, std::string_view home, const char* attribute) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found.empty()) return found;
  const OldWord* old = old_name_of(home, attribute);
  return old ? node.attribute(std::string(old->word).c_str()) : found;
}

/// @param known  the attributes that the element may have
void report_unknown_attribute(const Document& document, std::string_view element,
                              const pugi::xml_attribute& attribute,
                              std::span<const std::string_view> known, std::string_view elsewhere) {
  Report& report = document.report();
  const Location at = document.locate(attribute);
  const std::string_view name = attribute.name();
  const std::string value = in_quotes(attribute.value());
  if (!elsewhere.empty()) {
    return report.fault(at, fmt::format("the attribute {}={} can't stand in this <{}>: {}", name,
                                        value, element, elsewhere));
  }
  if (const OldWord* old = old_attribute(element, name)) {
    return report.notice(
        at, old->now.empty() ? notice_of(*old, element)
                             : fmt::format("{} of <{}> has no effect beside {}, which is the same",
                                           name, element, old->now));
  }
  if (document.lenient()) {
    return report.notice(at, fmt::format("unknown attribute {} of <{}> has no effect; {}",
                                         in_quotes(name), element, advice(name, known)));
  }
  const auto meant = nearest(name, known);
  const auto home = home_of_attribute(name);
  const bool is_of_other = home && home != element && !meant;
  report.fault(
      at,
      fmt::format("<{}> has an unknown attribute {}={}; {}{} (--lenient ignores it)", element, name,
                  value, is_of_other ? fmt::format("a <{}> has it", *home) : advice(name, known),
                  document.origin(attribute)));
  if (meant) report.left_out(*meant);
}

}  // namespace

Location Element::where() const { return document_->locate(node_.name() - 1); }

bool Element::has(const char* attribute) const { return !find(node_, name_, attribute).empty(); }

std::string_view written(const Element& element, const char* attribute) {
  return find(element.node_, element.name_, attribute).value();
}

Location Element::where(const char* attribute) const {
  const pugi::xml_attribute found = find(node_, name_, attribute);
  return found.empty() ? where() : document_->locate_value(found);
}

std::optional<std::string> Element::take(const char* attribute) {
  asked_attributes_.push_back(attribute);
  const pugi::xml_attribute found = find(node_, name_, attribute);
  if (found.empty()) return std::nullopt;
  if (found.name() != std::string_view(attribute)) {
    const OldWord& old = *old_name_of(name_, attribute);
    asked_attributes_.push_back(old.word);
    report().notice(document_->locate(found), notice_of(old, name_));
  }
  auto value = take_value(*document_, name(), found);
  const OldWord* old = value ? old_value(name_, attribute, *value) : nullptr;
  if (!old) return value;
  report().notice(document_->locate_value(found), notice_of(*old, name_));
  return std::string(old->now);
}

std::vector<std::pair<std::string, std::string>> Element::all_attributes() {
  any_attribute_ = true;
  std::vector<std::pair<std::string, std::string>> result;
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (auto value = take_value(*document_, name(), attribute)) {
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
    if (node.type() != pugi::node_element) continue;
    Element& child = result.emplace_back(*document_, node);
    const OldWord* old = old_element(name_, child.name_);
    if (!old || old->now.empty()) continue;
    report().notice(child.where(), notice_of(*old, name_));
    child.name_ = old->now;
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

std::vector<std::string> Element::asked() const {
  std::vector<std::string> names(asked_attributes_.begin(), asked_attributes_.end());
  names.insert(names.end(), asked_children_.begin(), asked_children_.end());
  return names;
}

void Element::done(std::string_view elsewhere, std::span<const std::string> names) {
  const auto is_elsewhere = [&](std::string_view name) {
    return !elsewhere.empty() && (names.empty() || std::ranges::find(names, name) != names.end());
  };
  check_repeated_attributes(*document_, node_);
  if (Vocabulary* vocabulary = document_->vocabulary()) element_at(*vocabulary, path());
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (any_attribute_) break;
    const std::string_view name = attribute.name();
    if (name.starts_with("xml:") || name.starts_with("xmlns")) continue;  // XML's own
    if (std::find(asked_attributes_.begin(), asked_attributes_.end(), name) ==
        asked_attributes_.end()) {
      report_unknown_attribute(*document_, name_, attribute, asked_attributes_,
                               is_elsewhere(name) ? elsewhere : std::string_view());
    }
  }
  for (const pugi::xml_node node : node_.children()) {
    if (!any_text_ && (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)) {
      report().notice(document_->locate(node.value()),
                      fmt::format("the text {} in <{}> has no effect here",
                                  in_quotes(trimmed(node.value())), name()));
    }
    if (node.type() != pugi::node_element || any_child_) continue;
    if (std::find(asked_children_.begin(), asked_children_.end(), node.name()) ==
        asked_children_.end()) {
      const Element child(*document_, node);
      if (!is_elsewhere(node.name())) {
        child.unknown_in(name(), asked_children_);
      } else {
        child.fault(fmt::format("can't stand in this <{}>: {}", name(), elsewhere));
      }
    }
  }
}

void Element::unknown_in(std::string_view parent, std::span<const std::string_view> known,
                         std::string_view home) const {
  if (const OldWord* old = old_element(parent, name())) {
    return report().notice(where(), notice_of(*old, parent));
  }
  const auto why = unsupported_element(name());
  const auto robot = robot_of_device(name());
  constexpr std::array<std::string_view, 5> plugin_lists{"actuators", "sensors", "arena", "entity",
                                                         "media"};
  const bool is_plugin =
      why || robot || std::ranges::find(plugin_lists, parent) != plugin_lists.end();
  if (document_->lenient() && is_plugin) {
    return report().notice(
        where(), fmt::format("<{}> in <{}> is not known here, and is left out", name(), parent));
  }
  if (why) {
    report().fault(
        where(), fmt::format("<{}> is not supported; {} (--lenient leaves it out)", name(), *why));
    return;
  }
  if (robot) {
    const std::string_view general = name().substr(name().find('_') + 1);
    const bool is_known = std::ranges::find(known, general) != known.end();
    report().fault(
        where(),
        fmt::format("<{}> is a device of the {}, which is not modelled here; {} (--lenient does)",
                    name(), *robot,
                    is_known ? fmt::format("remove it, or write <{}>", general) : "remove it"));
    return;
  }
  const auto meant = home.empty() ? nearest(name(), known) : std::nullopt;
  if (home.empty()) home = home_of(name()).value_or("");
  if (!home.empty() && home != parent && !meant) {
    report().fault(
        where(), fmt::format("<{}> can't stand in <{}>; write it into <{}>", name(), parent, home));
    report().left_out(home);
    report().left_out(name());
    return;
  }
  report().fault(
      where(),
      known.empty()
          ? fmt::format("unknown element <{}> in <{}>, which has no elements", name(), parent)
          : fmt::format("unknown element <{}> in <{}>; {}{}", name(), parent, advice(name(), known),
                        is_plugin ? " (--lenient leaves it out)" : ""));
  if (meant) report().left_out(*meant);
}

std::string Element::sentence(const char* attribute, std::string_view text) const {
  const pugi::xml_attribute found = find(node_, name_, attribute);
  return sentence_on(*document_, this->name(), found.empty() ? attribute : found.name(), found,
                     text);
}

void Element::fault_at(const char* attribute, std::string_view text,
                       std::vector<std::string_view> causes) const {
  report().fault(where(attribute), sentence(attribute, text), std::move(causes));
}

void Element::fault(std::string_view text, std::vector<std::string_view> causes) const {
  report().fault(where(), fmt::format("<{}> {}", name(), text), std::move(causes));
}

void missing(const Element& element, const char* attribute, std::string_view example) {
  element.fault(fmt::format("lacks the attribute {0}; write {0}=\"{1}\"", attribute, example),
                {attribute});
}

void missing_all(const Element& element, std::span<const std::string_view> attributes) {
  element.fault(fmt::format("lacks the attribute {}; write one", fmt::join(attributes, " or ")),
                {attributes.begin(), attributes.end()});
}

std::string Element::path() const {
  std::string path(node_.parent().parent() ? name() : std::string_view());
  for (pugi::xml_node up = node_.parent(); up.parent().parent(); up = up.parent()) {
    path = fmt::format("{}/{}", up.name(), path);
  }
  return path;
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

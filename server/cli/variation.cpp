#include "cli/variation.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "scene/settings.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

template <class T>
std::vector<T> read_all(const char* option, const std::vector<std::string>& texts,
                        scene::Value<T> (*read)(std::string_view)) {
  std::vector<T> result;
  for (const std::string& each : texts) {
    auto value = read(each);
    if (const auto* wrong = std::get_if<scene::Wrong>(&value)) {
      throw text::UsageError(fmt::format("{} {} {}", option, scene::in_quotes(each), wrong->text));
    }
    result.push_back(std::get<0>(std::move(value)));
  }
  return result;
}

}  // namespace

scene::Variation to_variation(const std::vector<std::string>& settings,
                              const std::vector<std::string>& parameters) {
  return {read_all("--set", settings, scene::to_setting),
          read_all("--param", parameters, scene::to_parameter)};
}

}  // namespace ziggurat::cli

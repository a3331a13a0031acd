// docs/lua-api.md names all that scripts find below `robot`, and nothing else.

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "lua_devices.h"

namespace ziggurat::lua {
namespace {

using Names = std::set<std::string>;

/// Every device with all that it can have; where there are ids, the device is called "<id>".
void equip(ScriptedRobot& robot) {
  robot.joints = {{"<id>", true, 0, true, 0, false}};
  robot.radios = {{"<id>", true, {}, true, {}}};
  robot.leds.resize(1);
  robot.directional_leds.resize(1);
  robot.tags.resize(1);
  robot.magnets = {{"<id>", {}}};
  robot.proximity.resize(1);
  robot.positioning.emplace();
  robot.battery.emplace();
  RangeAndBearing& bearing = robot.range_and_bearing.emplace();
  bearing.has_receiver = bearing.has_transmitter = true;
  bearing.packets.resize(1);
  Camera& camera = robot.cameras.emplace_back();
  camera.id = "<id>";
  camera.detects_leds = camera.detects_directional_leds = camera.detects_tags = true;
  camera.takes_images = true;
  add_driving(robot);
}

/// Logs the names, for example robot.joints.<id>.encoder or robot.proximity[i].
const char* const walk = R"lua(
  local function name_all(path, of)
    for key, value in pairs(of) do
      local name = type(key) == "number" and path .. "[i]" or path .. "." .. key
      local is_group = path == "robot" and key ~= "params"
      if type(value) == "table" and (is_group or key == "<id>") then
        name_all(name, value)
      else
        log(name)
      end
    end
  end
  name_all("robot", robot)
)lua";

/// The names in code marks of a table's first cell. `.name` goes on behind the name before it, a
/// bare one belongs to each of the section's tables.
void add_names(const std::string& cell, const std::vector<std::string>& section, Names& names) {
  static const std::regex code("`([^`]+)`");
  std::string parent;
  for (std::sregex_iterator each(cell.begin(), cell.end(), code), end; each != end; ++each) {
    const std::string text = (*each)[1];
    std::string name = text.substr(0, text.find('('));
    if (name.starts_with(".")) name = parent + name;
    if (name.starts_with("robot.")) {
      parent = name.substr(0, name.rfind('.'));
      names.insert(name);
      continue;
    }
    for (const std::string& table : section) names.insert(table + "." + name);
  }
}

Names documented() {
  static const std::regex array("`(robot\\.\\w+\\[i\\])`");
  std::ifstream document(ZIGGURAT_LUA_DOCUMENT);
  Names names;
  std::vector<std::string> section;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("#")) {
      section.clear();
      std::istringstream words(line.starts_with("### robot.") ? line.substr(4) : "");
      for (std::string word; words >> word;) {
        word.erase(std::remove(word.begin(), word.end(), ','), word.end());
        section.push_back(word);
      }
    }
    std::smatch found;
    if (std::regex_search(line, found, array)) names.insert(found[1]);
    if (line.starts_with("| `")) add_names(line.substr(2, line.find(" |", 2) - 2), section, names);
  }
  return names;
}

TEST_F(Devices, AreAllInTheDocument) {
  equip(robot_);
  EXPECT_RUNS(start(walk));
  Names found;
  for (const LogLine& line : robot().log.lines) found.insert(line.text);
  const Names named = documented();
  EXPECT_GT(found.size(), 50U);
  for (const std::string& name : found)
    EXPECT_TRUE(named.contains(name)) << name << " is not named";
  for (const std::string& name : named) {
    if (name.starts_with("robot.")) EXPECT_TRUE(found.contains(name)) << name << " is not there";
  }
}

}  // namespace
}  // namespace ziggurat::lua

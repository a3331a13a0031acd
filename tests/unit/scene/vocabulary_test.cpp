// SPDX-License-Identifier: MIT
#include "scene/vocabulary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "scene/reader.h"

namespace ziggurat::scene {
namespace {

const Asked& attribute(const Vocabulary& vocabulary, std::string_view parent, std::string_view name,
                       std::string_view attribute) {
  const auto element = std::ranges::find_if(vocabulary.elements, [&](const Described& one) {
    return one.parent == parent && one.name == name;
  });
  if (element == vocabulary.elements.end()) throw std::out_of_range(std::string(name));
  const auto found = std::ranges::find(element->attributes, attribute, &Asked::attribute);
  if (found == element->attributes.end()) throw std::out_of_range(std::string(attribute));
  return *found;
}

using Needs = std::vector<Need>;
using Texts = std::vector<std::string>;

TEST(Vocabulary, HasTypeUnitAndDefaultOfAttributes) {
  const Vocabulary all = whole_vocabulary({});
  const Asked& force =
      attribute(all, "controllers/lua_controller/actuators", "gripper", "max_force");
  EXPECT_EQ(force.type, "number > 0");
  EXPECT_EQ(force.unit, "N");
  EXPECT_EQ(force.needs, Needs{Need::optional});
  EXPECT_EQ(force.usual, Texts{"10000"});
  const Asked& mode = attribute(all, "arena/prototype/joints", "joint", "type");
  EXPECT_EQ(mode.type, "fixed|spherical|prismatic|revolute");
  EXPECT_EQ(mode.needs, Needs{Need::required});
}

TEST(Vocabulary, DefaultsAreAsAScenesAuthorWritesThem) {
  const Vocabulary all = whole_vocabulary({});
  const Asked& aperture =
      attribute(all, "arena", "foot-bot", "omnidirectional_camera_aperture");  // radians inside
  EXPECT_EQ(aperture.unit, "°");
  EXPECT_EQ(aperture.usual, Texts{"70"});
  EXPECT_EQ(attribute(all, "physics_engines", "dynamics3d", "clock").usual, Texts{"nominal"});
}

TEST(Vocabulary, AnAttributeOfSomeVariantsHasTheTypeOfThatWithAnEffect) {
  const Vocabulary all = whole_vocabulary({});
  const Asked& radius = attribute(all, "arena/prototype/links", "link", "radius");
  EXPECT_EQ(radius.type, "length");
  EXPECT_EQ(radius.needs, (Needs{Need::without_effect, Need::required}));
}

TEST(Vocabulary, IsRecordedWithoutAChangeOfWhatIsRead) {
  const std::string text =
      "<argos-configuration><arena size=\"1,1,1\" centre=\"0,0,0\"/></argos-configuration>";
  Vocabulary vocabulary;
  ReadOptions recorded;
  recorded.vocabulary = &vocabulary;
  const auto messages = [&](const ReadOptions& options) {
    Texts all;
    for (const Problem& problem : read_text(text, "s.argos", options).problems) {
      all.push_back(to_string(problem));
    }
    return all;
  };
  EXPECT_EQ(messages(recorded), messages({}));
  EXPECT_EQ(attribute(vocabulary, "", "arena", "center").usual, Texts{"0,0,0"});
}

}  // namespace
}  // namespace ziggurat::scene

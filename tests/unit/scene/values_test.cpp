// SPDX-License-Identifier: MIT
#include "scene/values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ziggurat::scene {
namespace {

template <class T>
T good(const Value<T>& value) {
  if (const Wrong* wrong = std::get_if<1>(&value)) {
    ADD_FAILURE() << wrong->text;
    return T{};
  }
  return std::get<0>(value);
}

template <class T>
std::string bad(const Value<T>& value) {
  const Wrong* wrong = std::get_if<1>(&value);
  return wrong ? wrong->text : "accepted";
}

template <class T>
bool accepted(const Value<T>& value) {
  return value.index() == 0;
}

TEST(Number, IsAFiniteDecimalWithAnOptionalF) {
  EXPECT_EQ(good(number("0.005f")), 0.005);
  EXPECT_EQ(good(number(".5")), 0.5);
  EXPECT_EQ(good(number("-.025")), -0.025);
  EXPECT_EQ(good(number("5.")), 5.0);
  EXPECT_EQ(good(number("+3")), 3.0);
  EXPECT_EQ(good(number("1e-3")), 0.001);
  EXPECT_EQ(good(number("7.0500949e-13")), 7.0500949e-13);
}

TEST(Number, RefusesEverythingElse) {
  for (const char* text :
       {"",      "-",   "+",   "+-5", "abc", "nan", "inf", "-inf",  "infinity", "1e",  "0x10",
        "1.5.2", "5,6", "1 2", "5ff", "5F",  "f",   ".",   "1e999", "-1e999",   "5 f", "١"}) {
    EXPECT_FALSE(accepted(number(text))) << text;
  }
  EXPECT_NE(bad(number("5cm")).find("has \"cm\" behind the number"), std::string::npos);
}

TEST(Number, IsCheckedAgainstItsLimits) {
  EXPECT_TRUE(accepted(non_negative("0")));
  EXPECT_FALSE(accepted(non_negative("-0.1")));
  EXPECT_FALSE(accepted(positive("0")));
  EXPECT_TRUE(accepted(length("0.000001")));
  EXPECT_FALSE(accepted(length("1e-7")));
  EXPECT_FALSE(accepted(length("1e-320")));
  EXPECT_FALSE(accepted(length("2e6")));
  EXPECT_TRUE(accepted(mass("0")));
  EXPECT_FALSE(accepted(mass("1e-12")));
  EXPECT_FALSE(accepted(mass("-1")));
  EXPECT_FALSE(accepted(probability("1.5")));
  EXPECT_FALSE(accepted(half_angle("181")));
  EXPECT_DOUBLE_EQ(good(half_angle("180")), std::numbers::pi);
  EXPECT_DOUBLE_EQ(good(angle("-90")), -std::numbers::pi / 2);
}

TEST(Integer, RefusesFractionsSignsAndOverflow) {
  EXPECT_EQ(good(count("0")), 0u);
  EXPECT_EQ(good(count("4294967295")), 4294967295u);
  EXPECT_EQ(good(count("10.0")), 10u);
  EXPECT_NE(bad(count("2.5")).find("has a fraction"), std::string::npos);
  for (const char* text : {"-1", "4294967296", "", "ten", "1e30", "0x10"}) {
    EXPECT_FALSE(accepted(count(text))) << text;
  }
  EXPECT_FALSE(accepted(positive_count("0")));
  EXPECT_EQ(good(seed("18446744073709551615")), 18446744073709551615u);
  EXPECT_FALSE(accepted(seed("18446744073709551616")));
  EXPECT_FALSE(accepted(Whole{1, 5}("6")));
}

TEST(Vector, HasExactlyTheExpectedNumberOfComponents) {
  EXPECT_EQ(good(vector3(" -.025,0, 0.02")), math::Vector3(-0.025, 0, 0.02));
  EXPECT_EQ(good(vector3("1 ,\n2,\t3f")), math::Vector3(1, 2, 3));
  EXPECT_NE(bad(vector3("1,2")).find("has 2 components instead of 3"), std::string::npos);
  EXPECT_NE(bad(vector3("1,2,3,4")).find("has 4 components"), std::string::npos);
  EXPECT_NE(bad(vector3("1,2,3,")).find("has 4 components"), std::string::npos);
  EXPECT_NE(bad(vector3("1,two,3")).find("component 2, \"two\", is not a number"),
            std::string::npos);
  EXPECT_FALSE(accepted(vector3("1,,3")));
  EXPECT_FALSE(accepted(vector3("")));
  EXPECT_NE(bad(vector3(std::string(100000, ','))).find("more than"), std::string::npos);
  EXPECT_EQ(good(vector2("884,885")), math::Vector2(884, 885));
  EXPECT_FALSE(accepted(vector2("1,2,3")));
  EXPECT_FALSE(accepted(positive_vector2("1,0")));
  EXPECT_FALSE(accepted(size("1,0,1")));
  EXPECT_FALSE(accepted(size("1,-1,1")));
  EXPECT_FALSE(accepted(position("0,0,1e7")));
  EXPECT_EQ(good(cells("20,20,1")), (std::array{20u, 20u, 1u}));
  EXPECT_FALSE(accepted(cells("20,0,1")));
  EXPECT_FALSE(accepted(resolution("640.5,360")));
}

TEST(Direction, IsNormalisedAndNotZero) {
  EXPECT_EQ(good(direction("0,0,5")), math::Vector3::UnitZ());
  EXPECT_NEAR(good(direction("1,1,0")).norm(), 1.0, 1e-15);
  EXPECT_NEAR(good(direction("1e-200,1e-200,0")).norm(), 1.0, 1e-15);
  EXPECT_NEAR(good(direction("1e300,1e300,0")).norm(), 1.0, 1e-15);
  EXPECT_FALSE(accepted(direction("0,0,0")));
}

TEST(Orientation, ComposesAsQxQyQz) {
  // Measured in beta50: `30,40,50` turns by 1.335488 about (0.749055, 0.317544, 0.581448).
  const Eigen::AngleAxisd turn(good(orientation("30,40,50")));
  EXPECT_NEAR(turn.angle(), 1.335488, 1e-6);
  EXPECT_NEAR((turn.axis() - math::Vector3(0.749055, 0.317544, 0.581448)).norm(), 0, 2e-6);
  // The camera of the dialect's example: `-90,90,0` looks along +x, with y down.
  const math::Quaternion camera = good(orientation("-90,90,0"));
  EXPECT_NEAR((camera * math::Vector3::UnitZ() - math::Vector3::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((camera * math::Vector3::UnitY() + math::Vector3::UnitZ()).norm(), 0, 1e-12);
  // The last angle turns about x.
  const math::Quaternion wheel = good(orientation("0,0,-90"));
  EXPECT_NEAR((wheel * math::Vector3::UnitZ() - math::Vector3::UnitY()).norm(), 0, 1e-12);
  EXPECT_FALSE(accepted(orientation("0,0")));
}

TEST(Range, IsMinColonMax) {
  EXPECT_EQ(good(range("0.025:0.25")), std::pair(0.025, 0.25));
  EXPECT_EQ(good(range(" -90 : 90 ")), std::pair(-90.0, 90.0));
  EXPECT_EQ(good(range("1:1")), std::pair(1.0, 1.0));
  for (const char* text : {"", "1", "1:", ":1", "1:2:3", "a:b", "2:1", "0,1"}) {
    EXPECT_FALSE(accepted(range(text))) << text;
  }
  EXPECT_FALSE(accepted(positive_range("0:1")));
}

TEST(Boolean, IsTrueOrFalse) {
  EXPECT_TRUE(good(boolean("true")));
  EXPECT_FALSE(good(boolean("false")));
  for (const char* text : {"", "True", "TRUE", "1", "0", "yes"}) {
    EXPECT_FALSE(accepted(boolean(text))) << text;
  }
}

TEST(ColorValue, IsANameOrFourChannels) {
  EXPECT_EQ(good(color("orange")), (Color{255, 140, 0}));
  EXPECT_EQ(good(color("gray50")), (Color{127, 127, 127}));
  EXPECT_EQ(good(color("0, 1,\n2,0")), (Color{0, 1, 2}));
  for (const char* text :
       {"", "Red", "gray55", "1,2,3", "1,2,3,4,5", "256,0,0,0", "-1,0,0,0", "1.5,0,0,0", "pink"}) {
    EXPECT_FALSE(accepted(color(text))) << text;
  }
}

TEST(Identifier, IsNotEmptyAndHasALimitedLength) {
  EXPECT_EQ(good(identifier("wheel.1")), "wheel.1");
  EXPECT_FALSE(accepted(identifier("")));
  EXPECT_FALSE(accepted(identifier("a\nb")));
  EXPECT_TRUE(accepted(identifier(std::string(255, 'x'))));
  EXPECT_FALSE(accepted(identifier(std::string(256, 'x'))));
}

TEST(InQuotes, ShortensWithoutSplittingCharacters) {
  EXPECT_EQ(in_quotes("a\nb"), "\"a b\"");
  std::string long_text(59, 'x');
  long_text += "éééé";
  EXPECT_EQ(in_quotes(long_text), "\"" + std::string(59, 'x') + "…\"");
}

TEST(Values, AResponseMayHaveManyPoints) {
  std::string text;
  for (int i = 1; i <= 1000; ++i) text += (i > 1 ? "," : "") + std::to_string(i) + ":0.5";
  const Response table = good(response(text));
  ASSERT_EQ(table.points.size(), 1000U);
  EXPECT_EQ(table.points.back().distance, 1000);
  EXPECT_NE(bad(response(text + ",1001:0")).find("more than 1000 points"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::scene

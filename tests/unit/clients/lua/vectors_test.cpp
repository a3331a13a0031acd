// SPDX-License-Identifier: MIT
// vector2, vector3 and quaternion, and what older Luas had.

#include "script/vectors.h"

#include <array>
#include <memory>

#include "script/tables.h"
#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

class Vectors : public ScriptTest {};

TEST_F(Vectors, AddSubtractScaleCompareAndPrint) {
  EXPECT_EQ(logged(R"(
    local a, b = vector3(1, 2, 3), vector3({x = 4, y = 5, z = 6})
    log(tostring(a + b)) log(tostring(b - a)) log(tostring(-a)) log(tostring(2 * a * 0.5))
    log(a == vector3(1, 2, 3), a == b, vector3() == vector3(0, 0, 0), vector3(a) == a)
    a.x = 10
    log(a.x, ' ', a:dot(b), ' ', vector2(3, 4):length(), ' ', tostring(vector2(1, 2) + vector2())))"),
            (Lines{"5,7,9", "3,3,3", "-1,-2,-3", "1,2,3", "1011", "10 68 5 1,2"}));
}

TEST_F(Vectors, TurnAndNormalizeInPlaceAndReturnThemselves) {
  EXPECT_EQ(logged(R"(
    local v = vector3(1, 0, 0)
    local same = v:cross(vector3(0, 1, 0)) == v
    log(same, ' ', tostring(v))
    v = vector3(0, 3, 4)
    log(tostring(v:normalize()), ' ', v.z)
    local u = vector2(2, 0):rotate(math.pi / 2)
    log(math.abs(u.x) < 1e-15, ' ', u.y)
    local w = vector3(0, 0, 2):rotate(quaternion(math.pi / 2, vector3(1, 0, 0)))
    log(math.abs(w.z) < 1e-15, ' ', w.y))"),
            (Lines{"1 0,0,1", "0,0.6,0.8 0.8", "1 2", "1 -2"}));
}

TEST_F(Vectors, QuaternionsComposeAsOrientationsOfScenesDo) {
  // The scene's "30,40,50": about z, then y, then x, all fixed axes.
  EXPECT_EQ(logged(R"(
    local function about(angle, x, y, z) return quaternion(math.rad(angle), vector3(x, y, z)) end
    local q = about(50, 1, 0, 0) * about(40, 0, 1, 0) * about(30, 0, 0, 1)
    local angle, axis = q:toangleaxis()
    log(angle, ' ', tostring(axis), ' ', tostring(q))
    local z, y, x = q:toeulerangles()
    log(math.deg(z), ' ', math.deg(y), ' ', math.deg(x))
    log(q.angle == angle, q.axis == axis, (q * q:inverse()).w, ' ', about(90, 0, 0, 1).yaw)
    for pitch = -90, 90, 180 do  -- where z and x turn about one axis
      local p = about(pitch, 0, 1, 0) * about(20, 0, 0, 1)
      z, y, x = p:toeulerangles()
      log(math.floor(math.deg(z) + 0.5), ' ', math.floor(math.deg(y) + 0.5), ' ', x)
    end)"),
            (Lines{"1.33549 0.749055,0.317544,0.581448 30,40,50", "30 40 50", "111 1.5708",
                   "20 -90 0", "20 90 0"}));
}

TEST_F(Vectors, WrongArgumentsAreErrorsOfTheScript) {
  for (const auto& [script, error] :
       {std::pair{"vector3(1, 2)", "write vector3(), vector3(v) or vector3(x, y, z)"},
        {"quaternion(1)", "write quaternion(), quaternion(q), quaternion(angle, axis)"},
        {"return vector3() + 1", "a vector3 {x =, y =, z =} expected, got number"},
        {"return vector3() * vector3()", "a:dot(b) is a product of two"},
        {"vector2():normalize()", "a vector2 of length 0 has no direction"},
        {"vector3():rotate(1)", "a quaternion {w =, x =, y =, z =} expected, got number"}}) {
    const Failure failure = start(std::string("\n") + script);
    ASSERT_TRUE(failure) << script;
    EXPECT_NE(failure->find(error), std::string::npos) << *failure;
  }
}

TEST_F(Vectors, PositioningGivesThem) {
  robot_.set_positioning(true);
  EXPECT_EQ(logged(R"(
    local here = robot.positioning
    log(tostring(here.position + vector3(1, 2, 3)), ' ', (here.position - vector3(3, 4, 0)):length())
    log(tostring(here.orientation), ' ', here.orientation.angle, ' ', here.orientation.axis.z)
    local z = here.orientation:toeulerangles()
    log(z))"),
            (Lines{"1,2,3 5", "0,0,0 0 1", "0"}));
}

TEST_F(Vectors, OlderFunctionsOfLuaAreThere) {
  EXPECT_EQ(logged(R"(
    log(unpack({1, 2, 3})) log(loadstring('return 4')()) log(table.maxn({5, [7] = 1}), ' ', table.maxn({}))
    log(('%d %5d %% %s %x'):format(3.7, -2.9, 1.5, 255.0))
    log(select(2, pcall(string.format, '%d', 'x')))
    log(select(2, pcall(string.format, '%d')))
    log(select(2, pcall(string.format, '%d', 1/0)))
    local n = math.random(2.5) log(n == 1 or n == 2, math.type(n))
    log(math.pow(2, 3), ' ', math.atan2(1, 0)))"),
            (Lines{"123", "4", "7 0", "3    -2 % 1.5 ff",
                   "bad argument #2 to 'string.format' (number expected, got string)",
                   "bad argument #2 to 'string.format' (no value)",
                   "bad argument #2 to 'string.format' (number has no integer representation)",
                   "1integer", "8 1.5708"}));
}

TEST(VectorsOfOtherLuas, ArePlainTables) {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), lua_close);
  push_vector(state.get(), std::array{1.0, 2.0, 3.0});
  EXPECT_EQ(lua_getmetatable(state.get(), -1), 0);
  set_vectors(state.get());
  push_vector(state.get(), std::array{1.0, 2.0, 3.0});
  EXPECT_EQ(lua_getmetatable(state.get(), -1), 1);
}

}  // namespace
}  // namespace ziggurat::lua

// What scripts find below `robot`, table by table. A script's fault fails its assert.

#include "lua_devices.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "script/colors.h"

namespace ziggurat::lua {
namespace {

std::vector<std::vector<int>> messages_of(const Outgoing& sent) {
  std::vector<std::vector<int>> messages;
  std::size_t begin = 0;
  for (const std::size_t end : sent.ends) {
    messages.emplace_back(sent.bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                          sent.bytes.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
  }
  return messages;
}

// ---- presence -----------------------------------------------------------------------------------

TEST_F(Devices, AreThereOnlyIfTheControllerHasThem) {
  EXPECT_RUNS(start(R"lua(
    for name, value in pairs(robot) do
      assert(name == "id" or name == "params" or name == "random", name)
    end
  )lua"));
}

TEST_F(Devices, HaveTheFunctionsAndReadingsThatAreEnabled) {
  robot_.radios = {{"ears", true, {}, false, {}}, {"mouth", false, {}, true, {}}};
  robot_.range_and_bearing.emplace().has_receiver = true;
  EXPECT_RUNS(start(R"lua(
    assert(robot.radios.ears.tx_data == nil and #robot.radios.ears.rx_data == 0)
    assert(robot.radios.mouth.rx_data == nil and robot.radios.mouth.tx_data)
    assert(robot.range_and_bearing.set_data == nil and #robot.range_and_bearing == 0)
    local names = {}
    for name, radio in pairs(robot.radios) do
      names[#names + 1] = name
      assert(type(radio) == "table")
    end
    assert(table.concat(names, " ") == "ears mouth")
  )lua"));
}

// ---- radios -------------------------------------------------------------------------------------

TEST_F(Devices, RadioMessagesAreArraysOfIntegers) {
  robot_.radios = {{"a", true, {}, false, {}}, {"b", true, {}, false, {}}};
  EXPECT_RUNS(start(R"lua(
    a, b = robot.radios.a.rx_data, robot.radios.b.rx_data
    function step()
      assert(a == robot.radios.a.rx_data, "the table is the same at every tick")
      expect()
    end
    function expect()
      assert(#a == 2 and #a[1] == 3 and #a[2] == 0 and #b == 0)
      assert(a[1][1] == 0 and a[1][3] == 255 and math.type(a[1][3]) == "integer")
      assert(a[1][3] + 1 .. "" == "256")
      kept = a[1]
      function expect()
        assert(#a == 1 and a[2] == nil and a[1][1] == 7, "what was heard before is gone")
        assert(#kept == 3, "but may be kept")
        function expect() assert(next(a) == nil) end
      end
    end
  )lua"));
  const std::array<std::uint8_t, 3> bytes{0, 128, 255};
  const std::array<std::uint8_t, 1> seven{7};
  const std::vector<Bytes> first{bytes, {}};
  const std::vector<Bytes> second{seven};
  robot().radios[0].received = first;
  EXPECT_RUNS(step());
  robot().radios[0].received = second;
  EXPECT_RUNS(step());
  robot().radios[0].received = {};
  EXPECT_RUNS(step());
}

TEST_F(Devices, RadioNumbersBecomeBytes) {
  robot_.radios = {{"r", false, {}, true, {}}};
  EXPECT_RUNS(start(R"lua(
    local tx = robot.radios.r.tx_data
    tx({0, 255, 256, 257, -1, -256, -257})
    tx({2.7, -0.9, -1.9, 255.99, 1e300, -2.0^53 - 2, 2^63, math.mininteger, math.maxinteger})
    tx({})
    tx({n = 1, 5})
  )lua"));
  EXPECT_EQ(messages_of(robot().radios[0].sent),
            (std::vector<std::vector<int>>{
                {0, 255, 0, 1, 255, 0, 255}, {2, 0, 255, 255, 0, 254, 0, 0, 255}, {}, {5}}));
}

TEST_F(Devices, RadioRefusesWhatIsNoMessageAndSendsNothingOfIt) {
  robot_.radios = {{"r", false, {}, true, {}}};
  EXPECT_RUNS(start(R"lua(
    local tx = robot.radios.r.tx_data
    refused("tx_data%(table%) expected, got 0", tx)
    refused("tx_data%(table%) expected, got 2", tx, {1}, {2})
    refused("table expected, got string", tx, "text")
    refused("table expected, got nil", tx, nil)
    refused("element 2 of the table, got string", tx, {1, "2"})
    refused("element 1 of the table, got boolean", tx, {true})
    refused("element 3 of the table, got inf or nan", tx, {1, 2, 0/0})
    refused("element 1 of the table, got inf or nan", tx, {math.huge})
    tx({9})
  )lua"));
  EXPECT_EQ(messages_of(robot().radios[0].sent), (std::vector<std::vector<int>>{{9}}));
}

TEST_F(Devices, RadioMessagesMayBeLongAndMany) {
  robot_.radios = {{"r", false, {}, true, {}}};
  EXPECT_RUNS(start(R"lua(
    local long = {}
    for i = 1, 65536 do long[i] = i end
    robot.radios.r.tx_data(long)
    for i = 1, 1000 do robot.radios.r.tx_data({i}) end
  )lua"));
  const auto messages = messages_of(robot().radios[0].sent);
  ASSERT_EQ(messages.size(), 1001U);
  EXPECT_EQ(messages[0].size(), 65536U);
  EXPECT_EQ(messages[1000], std::vector<int>{1000 % 256});
}

TEST_F(Devices, RadioLimitsAreErrorsThatAScriptMayCatch) {
  robot_.radio_limits = {4, 10, 5};
  robot_.radios = {{"r", false, {}, true, {}}, {"s", false, {}, true, {}}};
  EXPECT_RUNS(start(R"lua(
    local r, s = robot.radios.r.tx_data, robot.radios.s.tx_data
    refused("the message has 5 bytes; 4 are the most", r, {1, 2, 3, 4, 5})
    r({1, 2, 3, 4})
    s({1, 2, 3, 4})
    refused("sends 11 bytes at this tick; 10 are the most", r, {1, 2, 3})
    r({})
    s({})
    r({})
    refused("message 6 of the robot at this tick; 5 are the most", r, {})
  )lua"));
  EXPECT_EQ(robot().radios[0].sent.ends.size(), 3U);
}

// ---- LEDs ---------------------------------------------------------------------------------------

TEST_F(Devices, LedColorsInAllForms) {
  robot_.leds.resize(6);
  EXPECT_RUNS(start(R"lua(
    local set = robot.leds.set_single_color
    set(1, "red")
    set(2, "1,2,3,4")
    set(3.9, 10, 20.9, 300)
    set(4, " 4 , 5, 6,255")
    set(5, -1, 256, 0)
  )lua"));
  const auto& leds = robot().leds;
  EXPECT_EQ(leds[0].value, (Color{255, 0, 0}));
  EXPECT_EQ(leds[1].value, (Color{1, 2, 3}));
  EXPECT_EQ(leds[2].value, (Color{10, 20, 44}));
  EXPECT_EQ(leds[3].value, (Color{4, 5, 6}));
  EXPECT_EQ(leds[4].value, (Color{255, 0, 0}));
  EXPECT_TRUE(leds[4].is_fresh);
  EXPECT_FALSE(leds[5].is_fresh) << "the scene's color stays";
}

TEST_F(Devices, AllLedsAtOnceAndEachKindByItself) {
  robot_.leds.resize(3);
  robot_.directional_leds.resize(2);
  EXPECT_RUNS(start(R"lua(
    robot.leds.set_all_colors(255,0,0)
    robot.directional_leds.set_all_colors("gray40")
    robot.directional_leds.set_single_color(2, 1, 2, 3)
  )lua"));
  for (const auto& led : robot().leds) EXPECT_EQ(led.value, (Color{255, 0, 0}));
  EXPECT_EQ(robot().directional_leds[0].value, (Color{102, 102, 102}));
  EXPECT_EQ(robot().directional_leds[1].value, (Color{1, 2, 3}));
}

TEST_F(Devices, LedsRefuseWhatIsNoColorOrNoLed) {
  robot_.leds.resize(2);
  EXPECT_RUNS(start(R"lua(
    local one, all = robot.leds.set_single_color, robot.leds.set_all_colors
    for _, index in ipairs({0, 3, -1, 1e9, 10^300, 0.9, math.mininteger}) do
      refused("this robot has 2 LEDs, counted from 1", one, index, "red")
    end
    refused("number expected, got string", one, "1", "red")
    refused("finite number expected", one, 0/0, "red")
    refused("is no colour", one, 1, "reddish")
    refused("is no colour", one, 1, "1,2,3")
    refused("is no colour", one, 1, "1,2,3,256")
    refused("is no colour", one, 1, "1,2,3,4,5")
    refused("is no colour", one, 1, "")
    refused("string expected, got nil", one, 1, nil)
    refused("string expected, got number", one, 1, 5)
    refused("finite number expected", one, 1, 0, 0/0, 0)
    refused("number expected, got string", one, 1, 0, "0", 0)
    refused("got 1$", one, 1)
    refused("got 3$", one, 1, 2, 3)
    refused("got 5$", one, 1, 2, 3, 4, 5)
    refused("got 0$", all)
    refused("got 2$", all, 1, 2)
    refused("got 4$", all, 1, 2, 3, 4)
  )lua"));
  EXPECT_FALSE(robot().leds[0].is_fresh);
}

TEST(Colors, AreThoseOfTheSceneFormat) {
  EXPECT_EQ(parse_color("orange"), (Color{255, 140, 0}));
  EXPECT_EQ(parse_color("gray90"), (Color{229, 229, 229}));
  EXPECT_EQ(parse_color("0,0,0,0"), (Color{}));
  for (const char* wrong :
       {"Red", "gray45", "1,2,3,", ",,,", "1,2,3,-4", "1.5,2,3,4", "0x1,2,3,4"}) {
    EXPECT_FALSE(parse_color(wrong)) << wrong;
  }
}

// ---- tags and magnets ---------------------------------------------------------------------------

TEST_F(Devices, TagPayloads) {
  robot_.tags.resize(3);
  EXPECT_RUNS(start(R"lua(
    local one, all = robot.tags.set_single_payload, robot.tags.set_all_payloads
    all("x")
    one(2, "zero \0 inside")
    refused("this robot has 3 tags", one, 4, "x")
    refused("string expected, got number", one, 1, 5)
    refused("string expected, got nil", all, nil)
    refused("65537 bytes; 65536 are the most", all, ("x"):rep(65537))
    refused("got 1$", one, 1)
    refused("got 0$", all)
  )lua"));
  EXPECT_EQ(robot().tags[0].value, "x");
  EXPECT_EQ(robot().tags[1].value, std::string("zero \0 inside", 13));
  EXPECT_TRUE(robot().tags[2].is_fresh);
}

TEST_F(Devices, MagnetCurrents) {
  robot_.magnets = {{"magnet_0", {}}, {"grip per", {}}};
  EXPECT_RUNS(start(R"lua(
    robot.magnets["grip per"].set_current(-2)
    local set = robot.magnets.magnet_0.set_current
    refused("finite number expected", set, 0/0)
    refused("finite number expected", set, -math.huge)
    refused("number expected, got string", set, "1")
    refused("set_current%(current%) expected, got 0", set)
  )lua"));
  EXPECT_EQ(robot().magnets[1].current.value, -2);
  EXPECT_TRUE(robot().magnets[1].current.is_fresh);
  EXPECT_FALSE(robot().magnets[0].current.is_fresh);
}

// ---- sensors ------------------------------------------------------------------------------------

TEST_F(Devices, ProximityIsAnArray) {
  robot_.proximity = {0, 0, 0};
  EXPECT_RUNS(start(R"lua(
    kept = robot.proximity
    assert(#kept == 3 and kept[1] == 0 and kept[3] == 0)
    function step() assert(kept[1] == 0.25 and robot.proximity[3] == 1 and #kept == 3) end
  )lua"));
  robot().proximity = {0.25, 0, 1};
  EXPECT_RUNS(step());
}

TEST_F(Devices, ProximityThatTellsItsAnglesIsAnArrayOfTables) {
  robot_.proximity = {0, 0, 0};
  robot_.proximity_angles = {0.5, 1.5, -3};
  EXPECT_RUNS(start(R"lua(
    local all = robot.proximity
    local second, third = all[2], all[3]
    assert(#all == 3 and second.value == 0 and second.angle == 1.5 and third.angle == -3)
    all[1] = nil
    function step()
      assert(second.value == 0.25 and second.angle == 1.5 and third.value == 1)
      assert(robot.proximity == all and all[2] == second and all[1] == nil)
    end
  )lua"));
  robot().proximity = {0.75, 0.25, 1};
  EXPECT_RUNS(step());
}

TEST_F(Devices, PositioningIsPositionAngleAndAxis) {
  robot_.positioning.emplace();
  EXPECT_RUNS(start(R"lua(
    position, orientation = robot.positioning.position, robot.positioning.orientation
    assert(position.x == 0 and position.y == 0 and position.z == 0)
    assert(orientation.angle == 0 and orientation.axis.z == 1 and orientation.axis.x == 0)
    function step()
      assert(position.x == 1 and position.y == -2 and position.z == 3)
      assert(math.abs(orientation.angle - 3 * math.pi / 2) < 1e-12)
      assert(math.abs(orientation.axis.x + 1) < 1e-12 and orientation.axis.z == 0)
    end
  )lua"));
  const double half = 3 * std::acos(-1.0) / 4;
  *robot().positioning = {{1, -2, 3}, {std::cos(half), -std::sin(half), 0, 0}};
  EXPECT_RUNS(step());
}

TEST_F(Devices, BatteryReads) {
  robot_.battery.emplace();
  EXPECT_RUNS(start(R"lua(
    battery = robot.battery
    assert(battery.available_charge == 0 and battery.time_left == 0)
    function step() assert(battery.available_charge == 0.5 and battery.time_left == math.huge) end
  )lua"));
  *robot().battery = {0.5, std::numeric_limits<double>::infinity()};
  EXPECT_RUNS(step());
}

// ---- range and bearing --------------------------------------------------------------------------

TEST_F(Devices, RangeAndBearingPacketsAreInCentimetres) {
  robot_.range_and_bearing.emplace().has_receiver = true;
  EXPECT_RUNS(start(R"lua(
    heard = robot.range_and_bearing
    assert(#heard == 0)
    function step()
      assert(#heard == 2 and heard[1].range == 150 and heard[2].range == 0)
      assert(heard[1].horizontal_bearing == -0.5 and heard[1].vertical_bearing == 0.25)
      assert(#heard[1].data == 2 and heard[1].data[2] == 255)
      assert(math.type(heard[1].data[1]) == "integer")
      function step() assert(#heard == 0) end
    end
  )lua"));
  const std::array<std::uint8_t, 2> data{1, 255};
  robot().range_and_bearing->packets = {{1.5, -0.5, 0.25, data}, {0, 0, 0, data}};
  EXPECT_RUNS(step());
  robot().range_and_bearing->packets.clear();
  EXPECT_RUNS(step());
}

TEST_F(Devices, RangeAndBearingData) {
  RangeAndBearing& device = robot_.range_and_bearing.emplace();
  device.has_transmitter = true;
  device.data.value.resize(3);
  EXPECT_RUNS(start(R"lua(
    local device = robot.range_and_bearing
    device.set_data({1, 2, 3})
    device.set_data(2, 258.5)
    refused("2 numbers; this robot sends packets of 3 bytes", device.set_data, {1, 2})
    refused("4 numbers", device.set_data, {1, 2, 3, 4})
    refused("element 3 of the table, got string", device.set_data, {7, 7, "7"})
    refused("counted from 1", device.set_data, 4, 1)
    refused("counted from 1", device.set_data, 0, 1)
    refused("finite number expected", device.set_data, 1, 0/0)
    refused("table expected, got number", device.set_data, 1)
    refused("got 3$", device.set_data, 1, 2, 3)
    refused("clear_data%(%) expected, got 1", device.clear_data, 1)
    function step() robot.range_and_bearing.clear_data() end
  )lua"));
  auto& data = robot().range_and_bearing->data;
  EXPECT_EQ(data.value, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_TRUE(data.is_fresh);
  EXPECT_RUNS(step());
  EXPECT_EQ(data.value, (std::vector<std::uint8_t>{0, 0, 0}));
}

// ---- memory -------------------------------------------------------------------------------------

TEST_F(Devices, TablesAreMadeOnce) {
  robot_.radios = {{"r", true, {}, true, {}}};
  robot_.leds.resize(4);
  robot_.proximity.resize(24);
  robot_.positioning.emplace();
  robot_.battery.emplace();
  add_driving(robot_);
  robot_.cameras.resize(1);
  robot_.cameras[0].detects_tags = true;
  EXPECT_RUNS(start(R"lua(
    collectgarbage("stop")
    function step()
      local used = collectgarbage("count")
      assert(before == nil or used == before, "a tick takes memory")
      robot.leds.set_all_colors(1, 2, 3)
      before = collectgarbage("count")
    end
  )lua"));
  for (int i = 0; i < 20; ++i) EXPECT_RUNS(step());
}

}  // namespace
}  // namespace ziggurat::lua

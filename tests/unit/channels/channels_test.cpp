// SPDX-License-Identifier: MIT
// Channels say what the world's state says.

#include "channels/channels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shown_world.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::channels {
namespace {

using testing::ShownWorld;

math::Vector3 vector_at(const auto& packed, int place) {
  return {packed[3 * place], packed[3 * place + 1], packed[3 * place + 2]};
}

math::Quaternion rotation_at(const auto& packed, int place) {
  return math::Quaternion(packed[4 * place], packed[4 * place + 1], packed[4 * place + 2],
                          packed[4 * place + 3]);
}

TEST(Channels, WorldHasEntitiesLinksAndDevices) {
  ShownWorld shown;
  const auto world = shown.read<v1::World>("/world");
  EXPECT_EQ(world.generation(), 1u);
  EXPECT_EQ(world.scene(), "small.argos");
  EXPECT_EQ(world.tick_ns(), 100'000'000u);
  ASSERT_EQ(world.entities_size(), 2);
  const auto &arm = world.entities(0), &crate = world.entities(1);
  EXPECT_EQ(arm.id(), "arm");
  EXPECT_EQ(arm.kind(), v1::World::Entity::PROTOTYPE);
  EXPECT_EQ(arm.robot(), 0u);
  EXPECT_EQ(arm.link_count(), 2u);
  EXPECT_FALSE(crate.has_robot());
  EXPECT_EQ(crate.kind(), v1::World::Entity::BOX);
  ASSERT_EQ(world.links_size(), 3);
  EXPECT_EQ(world.links(1).frame(), "arm/tip");
  EXPECT_EQ(world.links(1).sphere().radius(), 0.02);
  EXPECT_EQ(world.links(2).frame(), "crate");
  EXPECT_EQ(world.links(2).box().size(2), 0.4);
  EXPECT_EQ(world.links(2).color(), 0xd3a469u) << "as in pictures";
  ASSERT_EQ(world.joints_size(), 1);
  EXPECT_EQ(world.joints(0).child(), 1u);
  ASSERT_EQ(world.robots_size(), 1);
  EXPECT_EQ(world.robots(0).description().joint_sensors(0).id(), "hinge");
  ASSERT_EQ(world.cameras_size(), 1);
  EXPECT_EQ(world.cameras(0).principal_point(1), 60);
  ASSERT_EQ(world.tags_size(), 1);
  EXPECT_EQ(world.tags(0).payload(), "7");
  EXPECT_EQ(world.tag_patterns_size(), 587);
  EXPECT_EQ(world.radios(0).range(), 2);
  EXPECT_EQ(world.controllers(0), "c");
}

TEST(Channels, PosesAreThoseOfTheState) {
  ShownWorld shown;
  shown.simulation.commands().joint_targets = {0.5};
  for (int i = 0; i < 10; ++i) shown.simulation.step();
  const world::State& state = shown.simulation.state();
  const auto world = shown.read<v1::World>("/world");
  const auto poses = shown.read<v1::Poses>("/poses");
  EXPECT_EQ(poses.tick(), 10u);
  EXPECT_EQ(poses.time_ns(), 1'000'000'000);
  ASSERT_EQ(poses.positions_size(), 9);
  for (int i = 0; i < 3; ++i) {
    const math::Pose& pose = state.links[static_cast<std::size_t>(i)].pose;
    EXPECT_LT((vector_at(poses.positions(), i) - pose.position).norm(), 1e-6);
    EXPECT_LT(rotation_at(poses.orientations(), i).angularDistance(pose.orientation), 1e-3);
  }
  ASSERT_EQ(poses.joint_positions_size(), 1);
  EXPECT_NEAR(poses.joint_positions(0), shown.simulation.observations().joint_readings[0], 1e-5);
  EXPECT_GT(poses.joint_positions(0), 0.3);
  // The origin, and a tag on it, from the pose of the reference link.
  const auto& arm = world.entities(0);
  const math::Pose origin =
      state.links[arm.reference_link()].pose *
      math::Pose{vector_at(arm.origin_position(), 0), rotation_at(arm.origin_orientation(), 0)};
  EXPECT_LT((origin.position - state.origins[0].position).norm(), 1e-9);
  const auto& mount = world.tags(0).mount();
  const math::Vector3 tag =
      state.links[mount.link()].pose * math::Vector3(vector_at(mount.position(), 0));
  EXPECT_LT((tag - world::position_of(state, shown.simulation.layout().tags[0].mount)).norm(),
            1e-9);
}

TEST(Channels, DevicesShowWhatTheyAreSetTo) {
  ShownWorld shown;
  EXPECT_EQ(shown.read<v1::Poses>("/poses").led_colors(0), 0x00ff00u);
  EXPECT_EQ(shown.read<v1::Poses>("/poses").tag_payloads_size(), 0);
  shown.simulation.commands().led_colors = {0x123456};
  shown.simulation.commands().tag_payloads = {"12"};
  shown.simulation.step();
  const auto poses = shown.read<v1::Poses>("/poses");
  EXPECT_EQ(poses.led_colors(0), 0x123456u);
  ASSERT_EQ(poses.tag_payloads_size(), 1);
  EXPECT_EQ(poses.tag_payloads(0).payload(), "12");
}

TEST(Channels, TheFloorIsAPictureAndWhatWasPaintedOnIt) {
  ShownWorld shown;
  EXPECT_TRUE(shown.read<v1::World>("/world").floor_picture().empty());
  shown.scene.floor_image =
      std::make_shared<const images::Image>(images::Image{2, 1, {255, 0, 0, 0, 255, 0}});
  shown.populate();
  EXPECT_EQ(shown.read<v1::World>("/world").floor_picture().substr(1, 3), "PNG");
  shown.simulation.commands().floor_paints = {{{1, 2}, {3, 4}, false, 0x123456},
                                              {{5, 6}, {7, 7}, true, 0xFF}};
  shown.simulation.step();
  const auto poses = shown.read<v1::Poses>("/poses");
  const auto& paints = poses.floor_paints();
  EXPECT_EQ(std::vector<double>(paints.begin(), paints.end()),
            std::vector<double>({1, 2, 3, 4, 0, 0x123456, 5, 6, 7, 7, 1, 0xFF}));

  // An image of a director takes the place of the scene's, and hides what is below.
  const std::string scene_picture = shown.read<v1::World>("/world").floor_picture();
  world::FloorPaint laid{{0, 0}, {20, 20}};
  laid.image = std::get<0>(world::floor_image("P5 1 1 255\nx"));
  shown.simulation.commands().floor_paints = {laid, {{1, 2}, {3, 4}, false, 0x123456}};
  shown.simulation.step();
  shown.populate();
  EXPECT_NE(shown.read<v1::World>("/world").floor_picture(), scene_picture);
  EXPECT_EQ(shown.read<v1::Poses>("/poses").floor_paints_size(), 6);
}

TEST(Channels, ARobotsReadingsAndCommandsAreThoseOfItsSession) {
  ShownWorld shown;
  shown.simulation.commands().joint_targets = {0.25};
  shown.simulation.step();
  shown.simulation.commands().radio_messages.add(0, std::vector<std::uint8_t>{'h', 'i'});
  const auto observation = shown.read<v1::Observation>("/robots/arm/observation");
  EXPECT_EQ(observation.tick(), 1u);
  ASSERT_EQ(observation.joint_readings_size(), 1);
  EXPECT_EQ(observation.joint_readings(0), shown.simulation.observations().joint_readings[0]);
  const auto command = shown.read<v1::Command>("/robots/arm/command");
  ASSERT_EQ(command.joint_targets_size(), 1);
  EXPECT_EQ(command.joint_targets(0), 0.25);
  EXPECT_EQ(command.tag_payloads(0), "7");
  ASSERT_EQ(command.radio_messages_size(), 1);
  EXPECT_EQ(command.radio_messages(0).payload(), "hi");
}

TEST(Channels, MessagesNameTheirSenderAndReceiver) {
  auto text = testing::equipped_scene();
  text.arena += simulation::testing::robot(
      "second", "0,-1,0",
      R"(<radios medium="air"><radio id="ear" anchor="base" position="0,0,0" range="1"/></radios>)");
  text.actuators = text.sensors = R"(<radios implementation="default"/>)";
  ShownWorld shown(text);
  EXPECT_TRUE(shown.encode("/radio").empty()) << "nothing was sent";
  shown.simulation.commands().radio_messages.add(0, std::vector<std::uint8_t>{'x'});
  shown.simulation.list_rays(true);
  shown.simulation.step();
  const auto rays = shown.read<v1::Rays>("/rays");  // though no radio has show_rays
  EXPECT_EQ(std::ranges::count(rays.kinds(), v1::Rays::RADIO), 1);
  EXPECT_EQ(rays.segments_size(), 6 * rays.kinds_size());
  EXPECT_TRUE(shown.simulation.state().rays.empty());
  const auto traffic = shown.read<v1::RadioTraffic>("/radio");
  ASSERT_EQ(traffic.messages_size(), 1);
  EXPECT_EQ(traffic.messages(0).sender(), 0u);
  EXPECT_EQ(traffic.messages(0).receiver(), 1u);
  EXPECT_EQ(traffic.messages(0).payload(), "x");
}

TEST(Channels, DetectionsAndAnnotationsAreWhatCamerasSee) {
  ShownWorld shown;  // the camera looks down on the tag and the LED of its own robot
  shown.simulation.step();
  const auto& seen = shown.simulation.observations().tags;
  ASSERT_EQ(seen.size(), 1u);
  const auto detections = shown.read<v1::Detections>("/detections");
  ASSERT_EQ(detections.cameras_size(), 1);
  const auto& tag = detections.cameras(0).tags(0);
  EXPECT_EQ(tag.tag(), 0u);
  EXPECT_EQ(tag.payload(), "7");
  EXPECT_EQ(tag.u(), seen[0].center.x());
  EXPECT_EQ(tag.corners_size(), 8);
  const auto drawn = shown.read<foxglove::ImageAnnotations>("/robots/arm/cameras/eye/annotations");
  ASSERT_EQ(drawn.points_size(), 1);
  EXPECT_EQ(drawn.points(0).points(0).x(), seen[0].corners[0].x());
  EXPECT_EQ(drawn.circles_size(), detections.cameras(0).leds_size());
  const auto calibration =
      shown.read<foxglove::CameraCalibration>("/robots/arm/cameras/eye/calibration");
  EXPECT_EQ(calibration.k(0), 100);
  EXPECT_EQ(calibration.k(5), 60);
  EXPECT_EQ(calibration.frame_id(), "arm/cameras/eye");
}

TEST(Channels, ContactsHaveForces) {
  auto text = testing::equipped_scene();
  text.engine = simulation::testing::ground;
  ShownWorld shown(text);
  shown.simulation.list_contacts(true);
  for (int i = 0; i < 30; ++i) shown.simulation.step();
  const auto contacts = shown.read<v1::Contacts>("/contacts");
  double weight = 0;
  for (int i = 0; 2 * i < contacts.links_size(); ++i) {
    if (contacts.links(2 * i) != 2) continue;  // the crate
    EXPECT_EQ(contacts.links(2 * i + 1), -1);
    weight += contacts.forces(3 * i + 2);
  }
  EXPECT_NEAR(weight, simulation::testing::g, 0.05 * simulation::testing::g);
}

TEST(Channels, FoxgloveFramesAreThePosesOfLinks) {
  ShownWorld shown;
  const auto frames = shown.read<foxglove::FrameTransforms>("/tf");
  ASSERT_EQ(frames.transforms_size(), 4) << "three links and a camera";
  EXPECT_EQ(frames.transforms(2).child_frame_id(), "crate");
  EXPECT_EQ(frames.transforms(2).translation().y(), 0.5);
  EXPECT_EQ(frames.transforms(3).parent_frame_id(), "arm/base");
  const auto scene = shown.read<foxglove::SceneUpdate>("/scene");
  ASSERT_EQ(scene.entities_size(), 4);
  EXPECT_EQ(scene.entities(0).frame_id(), "arm/base");
  EXPECT_TRUE(scene.entities(0).frame_locked());
  EXPECT_EQ(scene.entities(0).cubes_size(), 1);
  EXPECT_EQ(scene.entities(1).spheres_size(), 1);
  EXPECT_EQ(scene.entities(3).lines(0).points_size(), 24) << "a frustum";
  shown.channels.set_layers({true, false});
  const auto labelled = shown.read<foxglove::SceneUpdate>("/scene");
  ASSERT_EQ(labelled.entities_size(), 3);
  EXPECT_EQ(labelled.entities(2).texts(0).text(), "crate");
}

TEST(Channels, TopicsKeepTheirIds) {
  ShownWorld shown;
  const std::uint32_t id = shown.find("/robots/arm/observation")->id;
  scene::Entity late_entity = shown.scene.entities[0];
  late_entity.id = "late";
  late_entity.pose.position = {0, -1, 0};
  shown.simulation.spawn(shown.scene, late_entity);
  shown.populate();
  EXPECT_EQ(shown.find("/robots/arm/observation")->id, id);
  const std::uint32_t late = shown.find("/robots/late/observation")->id;
  EXPECT_GT(late, id);
  EXPECT_EQ(shown.read<v1::World>("/world").generation(), 2u);
  EXPECT_EQ(shown.read<v1::Poses>("/poses").generation(), 2u);
  shown.simulation.remove(0);
  shown.populate();
  EXPECT_FALSE(shown.find("/robots/arm/observation"));
  EXPECT_TRUE(shown.read<v1::World>("/world").entities(0).removed());
  EXPECT_EQ(shown.read<v1::World>("/world").entities_size(), 3) << "it keeps its places";
  shown.simulation.reset(shown.scene, {1});
  shown.populate();
  EXPECT_EQ(shown.find("/robots/arm/observation")->id, id);
  EXPECT_FALSE(shown.find("/robots/late/observation"));
}

TEST(Channels, OnlyWhatIsWantedIsEncoded) {
  ShownWorld shown;
  std::vector<Message> messages;
  const Moment moment{shown.simulation.state(),
                      shown.simulation.observations(),
                      shown.simulation.commands(),
                      {},
                      {}};
  shown.channels.encode(moment, Pace::tick, {}, messages);
  EXPECT_TRUE(messages.empty());
  const std::vector wanted{Channels::id_of(Kind::world), Channels::id_of(Kind::poses),
                           Channels::id_of(Kind::phases), 99999u};
  shown.channels.encode(moment, Pace::tick, wanted, messages);
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].channel, Channels::id_of(Kind::poses));
  shown.channels.encode(moment, Pace::latched, wanted, messages);
  EXPECT_EQ(messages.size(), 3u);
}

TEST(Channels, LinesAndLatenciesOfTheRun) {
  ShownWorld shown;
  foxglove::Log line;
  ASSERT_TRUE(line.ParseFromString(
      shown.channels.log(1'500'000'000, Severity::error, "arm", "stuck\xff").content->bytes()));
  EXPECT_EQ(line.level(), foxglove::Log::ERROR);
  EXPECT_EQ(line.timestamp().nanos(), 500'000'000);
  EXPECT_EQ(line.message().substr(0, 5), "stuck");
  wire::Status status;
  status.tick = 4;
  const std::vector<std::uint64_t> counts{0, 3, 1, 0, 0};
  v1::Barrier barrier;
  ASSERT_TRUE(barrier.ParseFromString(
      shown.channels.barrier(status, std::vector<Histogram>{{"c", 1e-6, 2, counts, 5}})
          .content->bytes()));
  EXPECT_EQ(barrier.status().tick(), 4u);
  EXPECT_EQ(barrier.histograms(0).counts_size(), 3);
  EXPECT_EQ(barrier.histograms(0).missed_ticks(), 5u);
  const Message measured = Channels::metrics(4, 800, {{"arm/blocks", 3}, {"judge/score", 0.5}});
  v1::Metrics metrics;
  ASSERT_TRUE(metrics.ParseFromString(measured.content->bytes()));
  EXPECT_EQ(measured.channel, Channels::id_of(Kind::metrics));
  EXPECT_EQ(measured.time_ns, 800);
  EXPECT_EQ(metrics.values().at("arm/blocks"), 3);
  EXPECT_EQ(metrics.values().at("judge/score"), 0.5);
}

TEST(Content, IsMadeOnceAndOnlyIfItIsAskedFor) {
  int made = 0;
  const Content content(
      [&made]() -> std::string {
        ++made;
        return "picture";
      },
      3);
  EXPECT_EQ(made, 0);
  EXPECT_EQ(content.bytes(), "picture");
  EXPECT_EQ(content.bytes(), "picture");
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace ziggurat::channels

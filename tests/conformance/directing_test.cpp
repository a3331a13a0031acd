// Directors, which version 1.4 of the protocol adds (docs/protocol.md, section 9.1). What their acts do to a
// world is tested by tests/scenes/directing_test.py.

#include <gtest/gtest.h>

#include <limits>

#include "network/barrier/directing.h"
#include "rules.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using Ids = std::vector<std::string>;

/// Boxes b0, b1, …: box i is at x = i, and has one LED.
struct Boxes {
  explicit Boxes(std::size_t count) {
    while (layout.entities.size() < count) add();
  }
  void add() {
    const std::size_t i = layout.entities.size();
    layout.entities.push_back({"b" + std::to_string(i), {i, 1}, false, {i, 1}});
    layout.links.push_back({"", i});
    layout.leds.push_back({.id = "led", .mount = {.entity = i}, .color = 7});
    entities.emplace_back().kind = scene::EntityKind::box;
    state.origins.push_back({{static_cast<double>(i), 0, 0}, math::Quaternion::Identity()});
    state.links.emplace_back().pose = state.origins.back();
    state.led_colors.push_back(static_cast<world::Color>(i));
    state.absent.push_back(false);
  }
  wire::Truth truth() const { return {layout, entities, state, observations, contacts}; }

  world::Layout layout;
  std::vector<scene::Entity> entities;
  world::State state;
  world::Observations observations;
  std::vector<world::Contact> contacts;
};

v1::ClientMessage director(const std::string& id) {
  auto message = Peers::hello("");
  v1::Hello& hello = *message.mutable_hello();
  hello.clear_robots();
  hello.mutable_version()->set_minor(4);
  hello.set_role(v1::ROLE_DIRECTOR);
  hello.set_director(id);
  hello.mutable_subscription()->add_groups(v1::Subscription::POSES);
  return message;
}

v1::ClientMessage direction(std::uint64_t tick) {
  v1::ClientMessage message;
  message.mutable_direction()->set_tick(tick);
  return message;
}

v1::ClientMessage pushes(std::uint64_t tick, std::vector<double> force) {
  auto message = direction(tick);
  v1::Push& push = *message.mutable_direction()->add_acts()->mutable_push();
  push.set_entity("b0");
  push.mutable_force()->Add(force.begin(), force.end());
  return message;
}

/// Two robots that "c" has, and the directors `judge` and, with a deadline of 50 ms, `hasty`.
struct Directing : ::testing::Test {
  explicit Directing(bool allows_others = false)
      : small(make_run()), peers(small, make_config(allows_others)), boxes(2) {
    peers.say("c", Peers::hello("*"));
    peers.inboxes.clear();
  }
  static SmallRun make_run() {
    SmallRun run(2);
    run.directors.push_back({.id = "judge"});
    run.directors.back().params = {{"height", "0.3"}};
    run.directors.back().script = "/scenes/judge.lua";
    run.directors.push_back({.id = "hasty"});
    run.directors.back().deadline = {scene::DeadlineAction::hold, 50, 2};
    return run;
  }
  static Config make_config(bool allows_others) {
    Config config;
    config.allows_directors = allows_others;
    return config;
  }
  /// Both directors are there; tick 5 is published, and "c" has answered it.
  void begin() {
    peers.say("p", director("judge"));
    peers.say("q", director("hasty"));
    publish(5);
    peers.say("c", Peers::command(5));
    peers.inboxes.clear();
  }
  void publish(std::uint64_t tick) {
    boxes.state.tick = tick;
    peers.observations = small.observations(tick);
    const wire::Truth truth = boxes.truth();
    network::publish(peers.barrier, peers.observations, peers.payloads, &truth);
  }
  /// What "p" was told since it was last asked.
  std::vector<v1::ServerMessage> told() { return std::exchange(peers.inboxes["p"], {}); }
  Ids answered() {
    Ids ids;
    for (const Directed& each : directions(peers.barrier)) ids.push_back(each.director);
    return ids;
  }

  SmallRun small;
  Peers peers;
  Boxes boxes;
};

struct DirectingFromOutside : Directing {
  DirectingFromOutside() : Directing(true) {}
};

TEST_F(Directing, R1_AHelloNamesADirectorOfTheScene) {
  EXPECT_EQ(refused(peers, director("")).code(), v1::Error::BAD_VALUE);
  EXPECT_EQ(refused(peers, director("other")).code(), v1::Error::FORBIDDEN);
  auto with_robots = director("judge");
  with_robots.mutable_hello()->add_robots("*");
  EXPECT_EQ(refused(peers, with_robots).code(), v1::Error::BAD_VALUE);
  peers.say("p", director("judge"));
  const v1::Welcome welcome = peers.told("p").welcome();
  EXPECT_EQ(welcome.role(), v1::ROLE_DIRECTOR);
  EXPECT_EQ(welcome.director().id(), "judge");
  EXPECT_EQ(welcome.director().script(), "/scenes/judge.lua");
  EXPECT_EQ(welcome.director().params(0).value(), "0.3");
  EXPECT_TRUE(welcome.robots().empty());
}

TEST_F(Directing, R1_ADirectorOfAnEarlierVersionIsNone) {
  auto hello = director("judge");
  hello.mutable_hello()->mutable_version()->set_minor(3);
  EXPECT_EQ(refused(peers, hello).code(), v1::Error::BAD_VALUE);
}

TEST_F(Directing, R1_ADirectorIsHeldByOneSessionUntilATakeover) {
  begin();
  auto other = director("judge");
  peers.say("r", other);
  const v1::ServerMessage taken = peers.told("r");
  EXPECT_EQ(taken.refusal().error().code(), v1::Error::ROBOT_TAKEN);
  EXPECT_TRUE(taken.refusal().error().retryable());
  EXPECT_EQ(taken.refusal().holder(), "tester");
  peers.inboxes.clear();
  other.mutable_hello()->set_takeover(true);
  peers.say("r", other);
  EXPECT_TRUE(peers.told("p").has_displaced());
  ASSERT_EQ(peers.inboxes["r"].size(), 3U);  // Welcome, WorldLayout, WorldState
  EXPECT_EQ(peers.inboxes["r"].back().world_state().tick(), 5U);
}

TEST_F(DirectingFromOutside, R1_OthersComeIfTheServerAllowsIt) {
  EXPECT_EQ(refused(peers, director("a b")).code(), v1::Error::BAD_VALUE);
  peers.say("r", director("third"));
  EXPECT_TRUE(peers.told("r").has_welcome());
  peers.say("s", director("fourth"));
  EXPECT_TRUE(peers.told("s").has_welcome());
  EXPECT_EQ(refused(peers, director("fifth")).code(), v1::Error::TOO_MANY);
}

TEST_F(DirectingFromOutside, R2_TheWorldWaitsForOneThatHasCome) {
  begin();
  peers.say("r", director("third"));
  peers.say("p", direction(5));
  peers.say("q", direction(5));
  EXPECT_FALSE(peers.is_complete());
  peers.say("r", direction(5));
  EXPECT_TRUE(peers.is_complete());
  peers.say("r", Peers::leave());
  publish(6);
  EXPECT_FALSE(peers.is_complete());
  peers.say("c", Peers::command(6));
  peers.say("p", direction(6));
  peers.say("q", direction(6));
  EXPECT_TRUE(peers.is_complete()) << "one that has left is not waited for";
  peers.inboxes.clear();
  peers.say("s", director("third"));
  EXPECT_EQ(peers.told("s").refusal().error().code(), v1::Error::NOT_YOURS);
}

TEST_F(Directing, R2_TheWorldWaitsForTheDirectorsOfItsScene) {
  EXPECT_FALSE(peers.is_gathered());
  peers.say("p", director("judge"));
  EXPECT_FALSE(peers.is_gathered());
  peers.say("q", director("hasty"));
  EXPECT_TRUE(peers.is_gathered());
}

TEST_F(Directing, R2_ADirectionIsForTheTickOfTheWorldState) {
  begin();
  EXPECT_EQ(faulted(peers, direction(4)).code(), v1::Error::STALE_TICK);
  EXPECT_EQ(faulted(peers, direction(6)).code(), v1::Error::FUTURE_TICK);
  auto of_another_epoch = direction(5);
  of_another_epoch.mutable_direction()->set_epoch(3);
  EXPECT_EQ(faulted(peers, of_another_epoch).code(), v1::Error::FUTURE_TICK);
  EXPECT_EQ(faulted(peers, Peers::command(5)).code(), v1::Error::OUT_OF_STATE);
  EXPECT_EQ(answered(), Ids{});
  peers.say("p", direction(5));
  EXPECT_EQ(answered(), Ids{"judge"});
  EXPECT_EQ(faulted(peers, direction(5)).code(), v1::Error::DUPLICATE_TICK);
  peers.say("c", direction(5));
  EXPECT_EQ(peers.told("c").error().code(), v1::Error::OUT_OF_STATE);
}

TEST_F(Directing, R2_BeforeTheFirstTickADirectionIsOutOfState) {
  peers.say("p", director("judge"));
  peers.inboxes.clear();
  EXPECT_EQ(faulted(peers, direction(0)).code(), v1::Error::OUT_OF_STATE);
}

TEST_F(Directing, R2_ADeadlineEndsTheWaitAndThenTheDirector) {
  begin();
  peers.say("p", direction(5));
  EXPECT_FALSE(peers.is_complete());
  for (std::uint64_t tick = 5; tick < 8; ++tick) {
    SCOPED_TRACE(tick);
    if (tick > 5) {
      publish(tick);
      peers.say("c", Peers::command(tick));
      peers.say("p", direction(tick));
    }
    peers.inboxes.clear();
    peers.pass(milliseconds(50));
    EXPECT_TRUE(peers.is_complete());
    EXPECT_EQ(answered(), Ids{"judge"}) << "who has missed the tick has no acts in it";
    const v1::ServerMessage missed = peers.told("q");
    EXPECT_EQ(missed.error().code(), v1::Error::DEADLINE_MISSED);
    EXPECT_EQ(missed.error().severity(), v1::Error::WARNING);
  }
  EXPECT_EQ(peers.take_report().dropped.size(), 1U);
  publish(8);
  peers.say("c", Peers::command(8));
  peers.say("p", direction(8));
  EXPECT_TRUE(peers.is_complete()) << "its budget of two is spent: it is dropped";
}

TEST_F(Directing, R2_ALateDirectionIsStaleAndNoBadMessage) {
  begin();
  peers.pass(milliseconds(50));
  peers.inboxes.clear();
  peers.say("q", direction(5));
  EXPECT_EQ(peers.told("q").error().code(), v1::Error::STALE_TICK);
  EXPECT_EQ(answered(), Ids{});
}

TEST_F(Directing, R2_ALostDirectorIsWaitedForAndResumesWithItsToken) {
  peers.say("p", director("judge"));
  const std::string token = peers.told("p").welcome().session_token();
  peers.say("q", director("hasty"));
  publish(5);
  peers.say("c", Peers::command(5));
  peers.say("q", direction(5));
  peers.unreachable.insert("p");
  peers.probe();
  EXPECT_FALSE(peers.is_complete());
  auto hello = director("");
  hello.mutable_hello()->set_session_token(token);
  hello.mutable_hello()->clear_subscription();
  auto as_controller = hello;
  as_controller.mutable_hello()->set_role(v1::ROLE_CONTROLLER);
  peers.say("r", as_controller);
  EXPECT_EQ(peers.told("r").refusal().error().code(), v1::Error::NO_SUCH_SESSION);
  peers.say("r", hello);
  const auto told = std::exchange(peers.inboxes["r"], {});
  ASSERT_EQ(told.size(), 3U);
  EXPECT_TRUE(told[0].welcome().has_resumed());
  EXPECT_EQ(told[1].world_layout().entities_size(), 2);
  EXPECT_EQ(told[2].world_state().poses_size(), 14) << "it keeps its subscription";
  peers.say("r", direction(5));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Directing, R2_AnAnswerThatIsSentAgainReplacesTheOneBefore) {
  peers.say("p", director("judge"));
  const std::string token = peers.told("p").welcome().session_token();
  peers.say("q", director("hasty"));
  publish(5);
  peers.say("p", pushes(5, {1, 0, 0}));
  auto hello = director("judge");
  hello.mutable_hello()->set_session_token(token);
  peers.say("r", hello);
  peers.say("r", pushes(5, {2, 0, 0}));
  const auto all = directions(peers.barrier);
  ASSERT_EQ(all.size(), 1U);
  const auto& acts = all[0].direction.acts;
  ASSERT_EQ(acts.size(), 1U);
  EXPECT_EQ(std::get<wire::Push>(acts[0]).force[0], 2);
}

TEST_F(Directing, R2_AResetIsTold) {
  begin();
  restart(peers.barrier, {.seed = 9});
  boxes = Boxes(1);
  publish(0);
  const auto messages = told();
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[0].reset().seed(), 9U);
  EXPECT_EQ(messages[1].world_layout().first(), 0U);
  EXPECT_EQ(messages[1].world_layout().entities_size(), 1);
  EXPECT_EQ(messages[2].world_state().epoch(), 1U);
}

TEST_F(Directing, R2_APauseIsTold) {
  begin();
  peers.say("p", direction(5));
  peers.say("q", direction(5));
  pause(peers.barrier);
  EXPECT_TRUE(peers.told("p").has_paused());
  EXPECT_FALSE(peers.is_complete());
}

TEST_F(Directing, R3_ADirectorIsToldWhatItSubscribedTo) {
  auto hello = director("judge");
  hello.mutable_hello()->mutable_subscription()->add_entities("b[1-9]");
  hello.mutable_hello()->mutable_subscription()->add_groups(v1::Subscription::LEDS);
  peers.say("p", hello);
  peers.inboxes.clear();
  publish(5);
  auto messages = told();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].world_layout().entities_size(), 1);
  EXPECT_EQ(messages[0].world_layout().entities(0).id(), "b1");
  EXPECT_EQ(messages[0].world_layout().entities(0).kind(), "box");
  EXPECT_EQ(messages[0].world_layout().entities(0).leds(0).color(), 7U);
  const v1::WorldState& state = messages[1].world_state();
  ASSERT_EQ(state.poses_size(), 7);
  EXPECT_EQ(state.poses(0), 1);
  EXPECT_EQ(state.poses(3), 1);
  EXPECT_EQ(state.led_colors(0), 1U);
  EXPECT_TRUE(state.links().empty());
  EXPECT_TRUE(state.joints().empty());
}

TEST_F(Directing, R3_WithoutSubscriptionItIsToldOfNothing) {
  auto hello = director("judge");
  hello.mutable_hello()->clear_subscription();
  peers.say("p", hello);
  peers.inboxes.clear();
  publish(5);
  const auto messages = told();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_TRUE(messages[0].world_layout().entities().empty());
  EXPECT_TRUE(messages[1].world_state().poses().empty());
}

TEST_F(Directing, R3_ASubscriptionHas64PatternsOf256Bytes) {
  auto hello = director("judge");
  for (int i = 0; i < 64; ++i) hello.mutable_hello()->mutable_subscription()->add_entities("b*");
  auto more = hello;
  more.mutable_hello()->mutable_subscription()->add_entities("b*");
  EXPECT_EQ(refused(peers, more).code(), v1::Error::TOO_MANY);
  auto longer = director("judge");
  longer.mutable_hello()->mutable_subscription()->add_entities(std::string(257, 'b'));
  EXPECT_EQ(refused(peers, longer).code(), v1::Error::TOO_MANY);
  peers.say("p", hello);
  EXPECT_TRUE(peers.told("p").has_welcome());
}

TEST_F(Directing, R4_EntitiesThatComeStandBehindTheOthersAndThoseThatGoKeepTheirPlaces) {
  begin();
  peers.say("p", direction(5));
  boxes.add();
  boxes.state.absent[0] = true;
  publish(6);
  auto messages = told();
  ASSERT_EQ(messages.size(), 2U);
  const v1::WorldLayout& layout = messages[0].world_layout();
  EXPECT_EQ(layout.first(), 2U);
  ASSERT_EQ(layout.entities_size(), 1);
  EXPECT_EQ(layout.entities(0).id(), "b2");
  ASSERT_EQ(layout.removed_size(), 1);
  EXPECT_EQ(layout.removed(0), 0U);
  EXPECT_EQ(messages[1].world_state().poses_size(), 21);
  publish(7);
  EXPECT_EQ(told().size(), 1U) << "nothing has changed: no layout";
}

TEST_F(Directing, R5_ContactsAreToldByTheirLinks) {
  auto hello = director("judge");
  hello.mutable_hello()->mutable_subscription()->add_entities("b1");
  hello.mutable_hello()->mutable_subscription()->add_groups(v1::Subscription::CONTACTS);
  peers.say("p", hello);
  boxes.contacts.push_back({.link = 0});
  boxes.contacts.push_back({.link = 0, .other = 1, .point = {1, 2, 3}, .normal = {0, 0, 1}, .force = {0, 0, 5}});
  boxes.contacts.push_back({.link = 1});
  peers.inboxes.clear();
  publish(5);
  const v1::WorldState state = told().back().world_state();
  EXPECT_EQ((std::vector<int>{state.contact_links().begin(), state.contact_links().end()}),
            (std::vector<int>{0, -2, 0, -1}))
      << "b0 is not told: the contact is turned round; that of b0 with the floor is left out";
  EXPECT_EQ(state.contacts(2), 3);
  EXPECT_EQ(state.contacts(5), -1);
  EXPECT_EQ(state.contacts(8), -5);
}

TEST_F(Directing, R6_ActsAreInTheOrderOfTheIds) {
  begin();
  peers.say("p", direction(5));
  peers.say("q", direction(5));
  EXPECT_EQ(answered(), (Ids{"hasty", "judge"}));
  publish(6);
  EXPECT_EQ(answered(), Ids{});
}

TEST_F(Directing, R7_AWrongDirectionHasNoEffect) {
  begin();
  peers.barrier.directors.check = [](const wire::Direction&) {
    return wire::Fault{.code = wire::ErrorCode::unknown_entity, .field = "acts[0].push.entity", .message = "No."};
  };
  auto wrong = pushes(5, {1, 0, 0});
  wrong.mutable_direction()->add_log()->set_text("not printed");
  v1::Metric& metric = *wrong.mutable_direction()->add_metrics();
  metric.set_name("x");
  const v1::Error error = faulted(peers, wrong);
  EXPECT_EQ(error.code(), v1::Error::UNKNOWN_ENTITY);
  EXPECT_EQ(error.field(), "acts[0].push.entity");
  EXPECT_TRUE(peers.barrier.directors.metrics.last().empty());
  EXPECT_EQ(answered(), Ids{});
  peers.barrier.directors.check = {};
  peers.say("p", pushes(5, {1, 0, 0}));
  EXPECT_EQ(answered(), Ids{"judge"});
}

TEST_F(Directing, R8_ValuesAreBounded) {
  begin();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& force : {std::vector<double>{1, 2}, {1, 2, 3, 4}, {infinity, 0, 0},
                                           {0, std::numeric_limits<double>::quiet_NaN(), 0}, {0, 0, -1.1e6}}) {
    const v1::Error error = faulted(peers, pushes(5, force));
    EXPECT_EQ(error.code(), v1::Error::BAD_VALUE);
    EXPECT_EQ(error.field(), "acts[0].push.force");
  }
  auto show = direction(5);
  show.mutable_direction()->add_acts()->mutable_show()->add_led_colors(0x1000000);
  EXPECT_EQ(faulted(peers, show).code(), v1::Error::BAD_VALUE);
  show.mutable_direction()->mutable_acts(0)->mutable_show()->clear_led_colors();
  show.mutable_direction()->mutable_acts(0)->mutable_show()->add_tag_payloads(std::string(65537, 'x'));
  EXPECT_EQ(faulted(peers, show).code(), v1::Error::TOO_LARGE);
  auto empty = direction(5);
  empty.mutable_direction()->add_acts();
  EXPECT_EQ(faulted(peers, empty).code(), v1::Error::BAD_VALUE);
}

TEST_F(Directing, K5_ADirectionHas10000ActsAnd1000Lines) {
  begin();
  auto lines = direction(5);
  for (int i = 0; i < 1001; ++i) lines.mutable_direction()->add_log();
  EXPECT_EQ(faulted(peers, lines).code(), v1::Error::TOO_MANY);
  auto acts = direction(5);
  for (int i = 0; i < 10001; ++i) acts.mutable_direction()->add_acts()->mutable_push()->set_entity("b0");
  EXPECT_EQ(faulted(peers, acts).code(), v1::Error::TOO_MANY);
  acts.mutable_direction()->mutable_acts()->RemoveLast();
  peers.say("p", acts);
  EXPECT_EQ(answered(), Ids{"judge"});
}

TEST_F(Directing, R9_MetricsAndLinesStandUnderTheIdOfTheDirector) {
  begin();
  auto message = direction(5);
  v1::Metric& metric = *message.mutable_direction()->add_metrics();
  metric.set_robot(77);
  metric.set_name("food");
  metric.set_value(3);
  message.mutable_direction()->add_log()->set_text("hello");
  peers.say("p", message);
  const auto metrics = metrics_of_tick(peers.barrier);
  ASSERT_EQ(metrics.size(), 1U);
  EXPECT_EQ(world::key_of(metrics[0]), "judge/food");
  const auto log = peers.take_report().log_of_directors;
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].director, "judge");
  EXPECT_EQ(log[0].text, "hello");
  metric.set_name("no name");
  publish(6);
  peers.inboxes.clear();
  message.mutable_direction()->set_tick(6);
  EXPECT_EQ(faulted(peers, message).code(), v1::Error::BAD_VALUE);
}

TEST_F(Directing, R9_ALeaveHasTheLastWords) {
  begin();
  auto leave = Peers::leave({}, v1::Leave::FAILED);
  leave.mutable_leave()->set_message("no food");
  leave.mutable_leave()->add_log()->set_text("good bye");
  v1::Metric& metric = *leave.mutable_leave()->add_metrics();
  metric.set_name("food");
  auto wrong = leave;
  wrong.mutable_leave()->add_robots(0);
  EXPECT_EQ(faulted(peers, wrong).code(), v1::Error::UNKNOWN_ROBOT);
  peers.say("p", leave);
  const Report report = peers.take_report();
  ASSERT_EQ(report.failed_directors.size(), 1U);
  EXPECT_EQ(report.failed_directors[0].message, "no food");
  EXPECT_EQ(report.log_of_directors.size(), 1U);
  EXPECT_EQ(peers.barrier.directors.metrics.last().size(), 1U);
  peers.say("q", direction(5));
  EXPECT_TRUE(peers.is_complete());
}

TEST_F(Directing, R9_ADirectionCountsAlthoughItsDirectorLeaves) {
  begin();
  peers.say("p", direction(5));
  peers.say("p", Peers::leave());
  peers.say("q", direction(5));
  EXPECT_TRUE(peers.is_complete());
  EXPECT_EQ(answered(), (Ids{"hasty", "judge"}));
}

TEST_F(Directing, R10_AResultHas1KiB) {
  begin();
  auto finish = direction(5);
  finish.mutable_direction()->mutable_finish()->set_result(std::string(1025, 'x'));
  EXPECT_EQ(faulted(peers, finish).code(), v1::Error::TOO_LARGE);
  finish.mutable_direction()->mutable_finish()->set_result("it stands");
  peers.say("p", finish);
  EXPECT_EQ(directions(peers.barrier).at(0).direction.finish, "it stands");
}

TEST_F(Directing, V12_AStatusNamesThem) {
  begin();
  wire::Status status;
  fill(peers.barrier, peers.now, status);
  ASSERT_EQ(status.sessions.size(), 3U);
  EXPECT_EQ(status.sessions[1].director, "judge");
  EXPECT_EQ(status.sessions[2].deadline.wall_deadline_ms, 50U);
}

}  // namespace
}  // namespace ziggurat::network

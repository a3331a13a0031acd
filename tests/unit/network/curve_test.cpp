// SPDX-License-Identifier: MIT
// CURVE on real sockets: who is on the list gets in, in the roles of its key; others get nothing.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "network/keys.h"
#include "network/local_server.h"
#include "network/small_run.h"
#include "temporary_folder.h"
#include "words_of.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

struct Keys : ::testing::Test {
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string write(const std::string& name, const std::string& text, mode_t mode = 0600) const {
    std::ofstream(path(name)) << text;
    ::chmod(path(name).c_str(), mode);
    return path(name);
  }
  static std::string complaint(auto action) { return words_of<KeyError>(action); }

  TemporaryFolder folder;
};

TEST_F(Keys, APairIsWrittenOnceAndReadBack) {
  const std::string key = write_key_pair(path("mine"));
  struct stat status {};
  ASSERT_EQ(::stat(path("mine.secret").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  const std::string secret = read_secret_key(path("mine.secret"));
  EXPECT_EQ(public_key_of(secret), key);
  EXPECT_NE(complaint([&] { write_key_pair(path("mine")); }).find("exists"), std::string::npos);
  EXPECT_EQ(read_secret_key(path("mine.secret")), secret);
}

TEST_F(Keys, ASecretThatOthersCanReadIsRefused) {
  write_key_pair(path("mine"));
  ::chmod(path("mine.secret").c_str(), 0640);
  const auto text = complaint([&] { read_secret_key(path("mine.secret")); });
  EXPECT_NE(text.find("chmod 600"), std::string::npos) << text;
  const auto nonsense = complaint([&] { read_secret_key(write("no", "not a key\n")); });
  EXPECT_NE(nonsense.find("keygen"), std::string::npos);
  EXPECT_NE(complaint([&] { read_secret_key(path("nowhere")); }), "");
}

TEST_F(Keys, TheListHasKeysRolesAndNames) {
  const std::string a = write_key_pair(path("a")), b = write_key_pair(path("b"));
  const auto clients = read_client_keys(write("list", "# who may connect\n\n" + a +
                                                          " controller,observer Alice's robots\n" +
                                                          b + "\tsupervisor,director\n"));
  ASSERT_EQ(clients.size(), 2U);
  EXPECT_EQ(clients[0].public_key, a);
  EXPECT_EQ(clients[0].name, "Alice's robots");
  EXPECT_TRUE(clients[0].roles.allow(wire::Role::observer));
  EXPECT_FALSE(clients[0].roles.allow(wire::Role::supervisor));
  EXPECT_FALSE(clients[1].roles.allow(wire::Role::controller));
  EXPECT_FALSE(clients[0].roles.allow(wire::Role::director));
  EXPECT_TRUE(clients[1].roles.allow(wire::Role::director));
}

TEST_F(Keys, EveryFaultOfTheListIsNamedWithItsLine) {
  const std::string a = write_key_pair(path("a"));
  const auto text = complaint([&] {
    read_client_keys(write("list", a + " controller\nshort controller\n" + a + " king\n" + a +
                                       "\n" + a + " observer\n"));
  });
  for (const auto* line : {":2:", ":3:", ":4:", ":5:"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
  EXPECT_EQ(text.find(":1:"), std::string::npos);
  EXPECT_NE(complaint([&] { read_client_keys(write("none", "# no key\n")); }), "");
}

TEST_F(Keys, ALineLimitsWhatAKeyMayDrive) {
  const std::string a = write_key_pair(path("a"));
  const auto clients = read_client_keys(write(
      "list", a + " controller,observer robots=r1,scout* controllers=wander takeover=no A = B\n"));
  ASSERT_EQ(clients.size(), 1U);
  const Scope& scope = clients[0].scope;
  EXPECT_TRUE(ScopeGlobs(scope).includes("scout7", "wander"));
  EXPECT_TRUE(ScopeGlobs(scope).includes("r1", "wander"));
  EXPECT_FALSE(ScopeGlobs(scope).includes("r11", "wander"));
  EXPECT_FALSE(ScopeGlobs(scope).includes("r1", "wanderer"));
  EXPECT_FALSE(scope.may_take_over);
  EXPECT_EQ(clients[0].name, "A = B");
  const Scope none;
  EXPECT_TRUE(ScopeGlobs(none).includes("any", "thing"));
}

TEST_F(Keys, FaultsOfLimitsAreNamed) {
  const std::string a = write_key_pair(path("a"));
  for (const auto& [line, part] :
       {std::pair(" controller robot=r1", "'robot=' limits nothing"),
        std::pair(" controller robots=", "robots= names nothing"),
        std::pair(" controller robots=a,,b", "empty pattern"),
        std::pair(" controller takeover=maybe", "write yes or no"),
        std::pair(" controller robots=a,", "empty pattern"),
        std::pair(" controller,", "are no roles"),
        std::pair(" controller robots=a robots=*", "robots= stands there twice"),
        std::pair(" controller takeover=no takeover=yes", "takeover= stands there twice"),
        std::pair(" controller Robots=a", "'Robots=' limits nothing"),
        std::pair(" controller take-over=no", "'take-over=' limits nothing"),
        std::pair(" controller Alice robots=a", "robots= stands in the name"),
        std::pair(" controller takeover =no", "takeover= stands in the name"),
        std::pair(" controller\tA\tControllers\t=\ta", "controllers= stands in the name"),
        std::pair(" observer robots=r1", "role controller")}) {
    const std::string file = write("list", a + line + "\n");
    const auto text = complaint([&] { read_client_keys(file); });
    EXPECT_NE(text.find(part), std::string::npos) << line << ": " << text;
  }
}

TEST_F(Keys, ANulByteIsNamed) {
  const std::string a = write_key_pair(path("a"));
  for (const std::string& line : {a + " contr" + '\0' + "oller", a + " controller robots=a" + '\0',
                                  a + " controller A" + '\0'}) {
    const std::string file = write("list", line + "\n" + a + " nonsense\n");
    const auto text = complaint([&] { read_client_keys(file); });
    EXPECT_NE(text.find("list:1: has a NUL byte, \\u0000"), std::string::npos) << text;
    EXPECT_NE(text.find("list:2: 'nonsense' are no roles"), std::string::npos)
        << "nothing is cut: " << text;
  }
}

struct Protected : Keys {
  Protected() {
    server_key = write_key_pair(path("server"));
    config.endpoints = {"tcp://127.0.0.1:*"};
    config.private_endpoint = "ipc://" + path("private");
    config.curve = {read_secret_key(path("server.secret")), {}};
    config.curve->clients.push_back({write_key_pair(path("friend")), {.controller = true}, ""});
    config.curve->clients.push_back({write_key_pair(path("viewer")), {.observer = true}, ""});
    write_key_pair(path("unlisted"));
  }
  Options options(const Server& server, const std::string& key, std::size_t endpoint = 1) const {
    Options options;
    options.endpoint = server.endpoints()[endpoint];
    if (!key.empty()) {
      options.server_key = server_key;
      options.curve_secret = path(key + ".secret");
    }
    options.connect_timeout = milliseconds{700};
    return options;
  }
  /// Options of a controller of one robot that asks for a deadline policy.
  Options wishing(const Server& server, const std::string& key, const std::string& robot,
                  Deadline::Action action) const {
    Options wish = options(server, key);
    wish.connect_timeout = milliseconds{20'000};
    wish.robots = {robot};
    wish.deadline = Deadline{};
    wish.deadline->action = action;
    wish.deadline->after = milliseconds{1000};
    return wish;
  }
  /// Serves clients for as long as `client` takes.
  void meanwhile(Server& server, auto client) const {
    std::atomic<bool> is_done = false;
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    std::thread thread([&] {
      client();
      is_done = true;
      EXPECT_EQ(::write(ends[1], "x", 1), 1);
    });
    const std::array<int, 1> descriptors{ends[0]};
    for (;;) {
      const auto outcome = server.gather({milliseconds{20'000}, descriptors});
      if (outcome != Outcome::complete) break;
      std::this_thread::sleep_for(milliseconds{5});  // it is complete at once
      if (is_done) break;
    }
    thread.join();
    ::close(ends[0]);
    ::close(ends[1]);
  }

  std::string server_key;
  Config config;
};

TEST_F(Protected, KeysOnTheListGetIn) {
  const SmallRun small(2);
  Server server(config, small.run());
  ASSERT_EQ(server.endpoints().size(), 2U);
  std::vector<std::thread> clients;
  const auto drive = [&](const std::string& key, std::size_t endpoint, const std::string& robot) {
    Options from = options(server, key, endpoint);
    from.connect_timeout = milliseconds{20'000};
    from.robots = {robot};
    ziggurat::Session session(from);
    while (session.next()) session.robots()[0].joint("hinge").set_target(1);
  };
  clients.emplace_back(drive, "friend", 1, "robot0");
  clients.emplace_back(drive, "", 0, "robot1");  // the private endpoint has no protection
  world::Commands commands = small.commands();
  ASSERT_EQ(server.gather(patience), Outcome::complete);
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    const world::Observations seen = small.observations(tick);
    server.publish(seen, no_tags);
    ASSERT_EQ(server.collect(commands, patience), Outcome::complete);
  }
  EXPECT_EQ(commands.joint_targets, (std::vector<double>{1, 1}));
  server.finish({});
  EXPECT_EQ(server.drain(patience), Outcome::complete);
  for (auto& client : clients) client.join();
}

TEST_F(Protected, OthersGetNoAnswerToAnything) {
  const SmallRun small(1);
  Server server(config, small.run());
  meanwhile(server, [&] {
    EXPECT_THROW(ziggurat::Session(options(server, "unlisted")), ConnectionError)
        << "not on the list";
    EXPECT_THROW(ziggurat::Session(options(server, "")), ConnectionError) << "no key at all";
    Options wrong = options(server, "friend");
    wrong.server_key = public_key_of(read_secret_key(path("unlisted.secret")));
    EXPECT_THROW(ziggurat::Session{wrong}, ConnectionError) << "another server's key";
  });
}

std::string complaint_of(const Options& options) {
  return words_of<std::exception>([&] { ziggurat::Session session(options); });
}

TEST_F(Protected, ARefusedKeyIsToldOnBothSides) {
  const SmallRun small(1);
  Server server(config, small.run());
  std::string unlisted, none, other;
  meanwhile(server, [&] {
    // Without a key the client breaks off itself, maybe before the server has looked: it comes
    // first.
    Options without = options(server, "");
    without.connect_timeout = milliseconds{20'000};
    none = complaint_of(without);
    Options from = options(server, "unlisted");
    from.connect_timeout = milliseconds{20'000};
    unlisted = complaint_of(from);
    Options wrong = options(server, "friend");
    wrong.connect_timeout = milliseconds{20'000};
    wrong.server_key = public_key_of(read_secret_key(path("unlisted.secret")));
    other = complaint_of(wrong);
  });
  EXPECT_NE(unlisted.find("refused key? The server does not have"), std::string::npos) << unlisted;
  EXPECT_NE(other.find("refused key? The server breaks off"), std::string::npos) << other;
  EXPECT_NE(none.find("refused key? The endpoint is protected"), std::string::npos) << none;
  const auto notices = server.take_report().notices;
  for (const char* why :
       {" is not in --curve-clients", "it expects another server key", "it has no key"}) {
    EXPECT_TRUE(std::ranges::any_of(notices, [&](const std::string& notice) {
      return notice.starts_with("A client was refused: ") && notice.find(why) != std::string::npos;
    })) << why;
  }
}

TEST_F(Protected, K10_AKeyDrivesOnlyRobotsOfItsScope) {
  const SmallRun small(3);
  config.curve->clients[0].scope = {{"robot1", "robot2"}, {}, true};
  config.curve->clients[1] = {
      config.curve->clients[1].public_key, {.controller = true}, "", {{}, {"nothing*"}, true}};
  Server server(config, small.run());
  meanwhile(server, [&] {
    Options from = options(server, "friend");
    from.connect_timeout = milliseconds{20'000};
    from.robots = {"robot0"};
    EXPECT_NE(complaint_of(from).find("FORBIDDEN"), std::string::npos) << "named by its id";
    from.robots = {"*"};
    ziggurat::Session session(from);
    ASSERT_EQ(session.robots().size(), 2U) << "a pattern means those of the scope";
    EXPECT_EQ(session.robots()[0].id(), "robot1");
    Options other = options(server, "viewer");
    other.connect_timeout = milliseconds{20'000};
    other.robots = {"*"};
    EXPECT_NE(complaint_of(other).find("FORBIDDEN"), std::string::npos) << "no robot is left";
  });
}

TEST_F(Protected, K11_AKeyOfAControllerCannotEndTheRunByItsDeadline) {
  const SmallRun small(2);
  config.curve->clients[0].roles = {.controller = true};
  config.curve->clients[1].roles = {.controller = true, .supervisor = true};
  Server server(config, small.run());
  meanwhile(server, [&] {
    const std::string told =
        complaint_of(wishing(server, "friend", "robot0", Deadline::Action::stop));
    EXPECT_NE(told.find("FORBIDDEN"), std::string::npos) << told;
    EXPECT_NE(told.find("it lacks the role `supervisor`"), std::string::npos) << told;
    EXPECT_EQ(complaint_of(wishing(server, "viewer", "robot1", Deadline::Action::stop)), "");
  });
}

TEST_F(Protected, K11_AKeyOfAControllerCannotLetTheWorldWaitLonger) {
  const SmallRun small(2);
  config.curve->clients[0].roles = {.controller = true};
  config.curve->clients[1].roles = {.controller = true, .supervisor = true};
  config.deadlines = {{{scene::DeadlineAction::hold, 1000, 0}, false},
                      {{scene::DeadlineAction::hold, 1000, 0}, false}};
  Server server(config, small.run());
  meanwhile(server, [&] {
    const std::string told =
        complaint_of(wishing(server, "friend", "robot0", Deadline::Action::wait));
    EXPECT_NE(told.find("FORBIDDEN"), std::string::npos) << told;
    EXPECT_NE(told.find("robot 'robot0' by hold:1000"), std::string::npos) << told;
    Options from = wishing(server, "friend", "robot0", Deadline::Action::drop);
    from.deadline->after = milliseconds{1001};
    EXPECT_NE(complaint_of(from).find("FORBIDDEN"), std::string::npos);
    from.deadline->after = milliseconds{1000};
    EXPECT_EQ(complaint_of(from), "");
    EXPECT_EQ(complaint_of(wishing(server, "viewer", "robot1", Deadline::Action::wait)), "")
        << "a supervisor may pause the world, too";
  });
}

TEST_F(Protected, K10_AKeyTakesOverOnlyIfItMay) {
  const SmallRun small(1);
  config.curve->clients[0].scope.may_take_over = false;
  config.curve->clients[1].roles.controller = true;
  Server server(config, small.run());
  meanwhile(server, [&] {
    Options from = options(server, "viewer");
    from.connect_timeout = milliseconds{20'000};
    from.robots = {"*"};
    ziggurat::Session session(from);
    Options other = options(server, "friend");
    other.connect_timeout = milliseconds{20'000};
    other.robots = {"*"};
    other.takeover = true;
    EXPECT_NE(complaint_of(other).find("FORBIDDEN"), std::string::npos);
    from.takeover = true;
    EXPECT_EQ(complaint_of(from), "");
  });
}

TEST_F(Protected, K3_ARoleThatTheKeyDoesNotHaveIsForbidden) {
  const SmallRun small(1);
  Server server(config, small.run());
  meanwhile(server, [&] {
    try {
      Options viewer = options(server, "viewer");
      viewer.connect_timeout = milliseconds{20'000};
      ziggurat::Session session(viewer);
      FAIL() << "a viewer drives";
    } catch (const ProtocolError& error) {
      EXPECT_EQ(error.details().code, "FORBIDDEN");
    }
  });
}

TEST_F(Protected, L12_ASessionIsResumedOnlyWithItsKey) {
  const SmallRun small(1);
  config.curve->clients[1].roles.controller = true;
  Server server(config, small.run());
  meanwhile(server, [&] {
    Options mine = options(server, "friend");
    mine.connect_timeout = milliseconds{20'000};
    mine.robots = {"*"};
    ziggurat::Session session(mine);
    for (const auto& [key, endpoint] : {std::pair("viewer", 1), std::pair("", 0)}) {
      Options other = options(server, key, static_cast<std::size_t>(endpoint));
      other.connect_timeout = milliseconds{20'000};
      other.session_token = session.token();
      try {
        ziggurat::Session stolen(other);
        ADD_FAILURE() << "resumed with " << key;
      } catch (const ProtocolError& error) {
        EXPECT_EQ(error.details().code, "FORBIDDEN");
      }
    }
    mine.session_token = session.token();
    EXPECT_EQ(ziggurat::Session(mine).token(), session.token());
  });
}

TEST_F(Protected, ClientsSayWhatIsWrongWithTheirKeys) {
  Options options;
  options.endpoint = "tcp://127.0.0.1:1";
  options.server_key = server_key;
  EXPECT_THROW(ziggurat::Session{options}, std::invalid_argument);
  options.curve_secret = path("nowhere");
  EXPECT_THROW(ziggurat::Session{options}, std::invalid_argument);
  options.curve_secret = path("friend.secret");
  options.server_key = "too short";
  EXPECT_THROW(ziggurat::Session{options}, std::invalid_argument);
}

}  // namespace
}  // namespace ziggurat::network

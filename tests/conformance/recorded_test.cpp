// SPDX-License-Identifier: MIT
// The messages of protocol/recorded: what was released once is understood forever, and an old
// client gets along with this server.

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "checkout/checkout.h"
#include "network/peers.h"

namespace ziggurat::network {
namespace {

namespace fs = std::filesystem;
using google::protobuf::util::MessageDifferencer;
using nlohmann::json;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Paths without suffix of all recorded messages whose name has `part`, sorted.
std::vector<fs::path> recorded(const std::string& part) {
  std::vector<fs::path> result;
  for (const auto& entry : fs::recursive_directory_iterator(checkout() / "protocol/recorded")) {
    const fs::path& path = entry.path();
    if (path.extension() != ".bin" || path.stem().string().find(part) == std::string::npos)
      continue;
    result.push_back(fs::path(path).replace_extension());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::string with(const fs::path& path, const char* suffix) { return path.string() + suffix; }

/// Whether everything that `old` says stands in `today`, which may say more.
bool includes(const json& today, const json& old) {
  if (old.is_object()) {
    for (const auto& [name, value] : old.items()) {
      if (!today.contains(name) || !includes(today[name], value)) return false;
    }
    return today.is_object();
  }
  if (!old.is_array()) return today == old;
  if (!today.is_array() || today.size() != old.size()) return false;
  for (std::size_t i = 0; i < old.size(); ++i) {
    if (!includes(today[i], old[i])) return false;
  }
  return true;
}

template <typename Message>
void expect_twins(const fs::path& path) {
  SCOPED_TRACE(path.stem());
  Message binary;
  Message twin;
  ASSERT_TRUE(binary.ParseFromString(content(with(path, ".bin"))));
  EXPECT_TRUE(binary.GetReflection()->GetUnknownFields(binary).empty())
      << "a number was taken away";
  EXPECT_EQ(v1::from_json(content(with(path, ".json")), twin), "");
  EXPECT_TRUE(MessageDifferencer::Equals(binary, twin));
  EXPECT_TRUE(
      includes(json::parse(v1::to_json(binary)), json::parse(content(with(path, ".json")))));
}

TEST(Recorded, EveryMessageIsItsJsonTwin) {
  ASSERT_GE(recorded("client_").size(), 16U);
  ASSERT_GE(recorded("server_").size(), 13U);
  for (const fs::path& path : recorded("client_")) expect_twins<v1::ClientMessage>(path);
  for (const fs::path& path : recorded("server_")) expect_twins<v1::ServerMessage>(path);
}

TEST(Recorded, EveryKindIsThere) {
  for (const auto* message : {v1::ClientMessage::descriptor(), v1::ServerMessage::descriptor()}) {
    const std::string side = message == v1::ClientMessage::descriptor() ? "client_" : "server_";
    for (int i = 0; i < message->field_count(); ++i) {
      EXPECT_FALSE(recorded(side + message->field(i)->name()).empty()) << message->field(i)->name();
    }
  }
}

TEST(Recorded, TheServerReadsAllRecordedMessagesOfClients) {
  wire::Inbox inbox;
  for (const fs::path& path : recorded("client_")) {
    SCOPED_TRACE(path.stem());
    const auto kind = inbox.parse(content(with(path, ".bin")));
    EXPECT_NE(kind, wire::Inbox::Kind::malformed);
    EXPECT_EQ(inbox.parse(content(with(path, ".json"))), kind);
  }
}

/// Plays the recorded exchange, in one of its forms, against today's barrier.
void replay(const char* suffix) {
  const SmallRun small(1);
  Peers peers(small);
  std::uint64_t tick = 0;
  for (const fs::path& path : recorded("exchange_")) {
    SCOPED_TRACE(path.stem());
    const std::string bytes = content(with(path, suffix));
    if (path.stem().string().find("client_") != std::string::npos) {
      peers.send_bytes("old", bytes);
      continue;
    }
    v1::ServerMessage old = message_of(bytes);
    if (old.has_observation()) peers.publish(tick++);
    if (old.has_end()) finish(peers.barrier, {wire::EndReason::finished, "", tick - 1});
    const v1::ServerMessage today = peers.told("old");
    if (old.has_welcome()) {
      old.mutable_welcome()->clear_session_token();      // it is random
      old.mutable_welcome()->clear_max_message_bytes();  // any is right
    }
    MessageDifferencer differences;
    differences.set_scope(MessageDifferencer::PARTIAL);  // it may say more than it did
    std::string report;
    differences.ReportDifferencesToString(&report);
    EXPECT_TRUE(differences.Compare(old, today)) << report;
  }
  EXPECT_EQ(tick, 2U);
  EXPECT_EQ(peers.commands.joint_targets[0], 1.5);
  EXPECT_EQ(peers.take_report().log.at(0).text, "hello");
  EXPECT_EQ(peers.barrier.sessions.size(), 0U);
}

TEST(Recorded, AnOldClientGetsAlong) { replay(".bin"); }
TEST(Recorded, AnOldClientGetsAlongInJson) { replay(".json"); }

}  // namespace
}  // namespace ziggurat::network

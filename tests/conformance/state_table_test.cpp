// SPDX-License-Identifier: MIT
// Every cell of docs/protocol.md's table of states and messages, read from the document itself.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "checkout/checkout.h"
#include "network/peers.h"

namespace ziggurat::network {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    const auto begin = cell.find_first_not_of(' ');
    const auto end = cell.find_last_not_of(' ');
    cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
  }
  return cells;
}

/// Rows of the table whose first header cell is `corner`, header first.
std::vector<std::vector<std::string>> read_table(const std::string& corner) {
  std::ifstream file(checkout() / "docs/protocol.md");
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    const bool is_header = line.starts_with("| " + corner + " |");
    if (rows.empty() && !is_header) continue;
    if (!line.starts_with("|")) break;
    if (!line.starts_with("|---")) rows.push_back(cells_of(line));
  }
  return rows;
}

constexpr std::uint64_t tick = 3;

/// Brings peer "p" into a state.
void bring(Peers& peers, const std::string& state) {
  if (state == "NEW") return;
  if (state == "HELLO") {  // the world is loading
    peers.say("p", Peers::hello("robot0"));
    peers.inboxes.clear();
    return;
  }
  peers.join("p", "robot0");
  if (state == "READY") return;
  if (state == "LOST") {
    peers.unreachable.insert("p");
    peers.probe();
    peers.unreachable.clear();
  } else if (state == "CLOSED") {
    peers.say("p", Peers::leave());  // robot1 stays for the next Hello
  } else if (state == "DRAINING") {
    peers.publish(tick);
    finish(peers.barrier, {});
  } else {
    peers.publish(tick);
    if (state != "STEPPING, owing") peers.say("p", Peers::command(tick));
    if (state == "PAUSED") {
      peers.join("q", "robot1");
      peers.say("q", Peers::command(tick));
      pause(peers.barrier);
    }
  }
  peers.inboxes.clear();
}

v1::ClientMessage message_of(const std::string& name) {
  if (name == "Hello") return Peers::hello("robot*");
  if (name == "Command") return Peers::command(tick, {1});
  if (name == "Leave") return Peers::leave();
  if (name == "Request") return Peers::request(9);
  return Peers::heartbeat(9);
}

/// Effect of a message, in the table's words.
std::string verdict(Peers& peers, const std::string& message) {
  peers.say("p", message_of(message));
  const v1::ServerMessage answer = peers.told("p");
  if (answer.has_error()) return v1::Error::Code_Name(answer.error().code());
  if (answer.has_response()) {
    return answer.response().id() == 9 ? v1::Error::Code_Name(answer.response().error().code())
                                       : "mixed up";
  }
  if (answer.has_refusal()) return v1::Error::Code_Name(answer.refusal().error().code());
  if (answer.has_welcome()) return "taken";
  if (answer.has_heartbeat()) return answer.heartbeat().sequence() == 9 ? "taken" : "mixed up";
  if (peers.status().empty()) return peers.barrier.sessions.size() == 0 ? "taken" : "ignored";
  const auto status = peers.status()[0];
  if (message == "Leave") {
    return status.membership == RobotStatus::Membership::gone ? "taken" : "ignored";
  }
  return peers.commands.joint_targets[0] == 1 ? "taken" : "ignored";
}

TEST(StateTable, EveryCellHolds) {
  const auto table = read_table("State");
  ASSERT_EQ(table.size(), 10U);
  const auto& header = table[0];
  std::size_t tested = 0;
  for (std::size_t row = 1; row < table.size(); ++row) {
    const std::string& state = table[row][0];
    for (std::size_t column = 1; column < header.size(); ++column) {
      SCOPED_TRACE(state + ", " + header[column]);
      const SmallRun small(2);
      Peers peers(small, {}, state == "HELLO" ? Peers::World::loading : Peers::World::loaded);
      bring(peers, state);
      EXPECT_EQ(verdict(peers, header[column]), table[row][column]);
      ++tested;
    }
  }
  EXPECT_EQ(tested, 45U);
}

TEST(ErrorTable, NamesEveryCodeOfTheProtocol) {
  const auto table = read_table("Number");
  const auto& codes = *v1::Error::Code_descriptor();
  ASSERT_EQ(static_cast<int>(table.size()), codes.value_count());  // header for CODE_UNSPECIFIED
  for (std::size_t row = 1; row < table.size(); ++row) {
    const auto* code = codes.FindValueByNumber(std::stoi(table[row][0]));
    ASSERT_NE(code, nullptr);
    EXPECT_EQ(table[row][1], code->name());
    EXPECT_EQ(code->name(), wire::to_string(static_cast<wire::ErrorCode>(code->number())));
  }
}

}  // namespace
}  // namespace ziggurat::network

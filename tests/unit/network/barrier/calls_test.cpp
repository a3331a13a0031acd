// SPDX-License-Identifier: MIT
#include "network/barrier/calls.h"

#include <gtest/gtest.h>

#include "network/barrier/journal.h"

namespace ziggurat::network {
namespace {

using Kind = wire::Request::Kind;
using wire::ErrorCode;
using wire::Role;

wire::Request request(Kind kind) {
  wire::Request request;
  request.kind = kind;
  return request;
}

ErrorCode verdict(Kind kind, Role role) {
  const auto fault = check_request(request(kind), role);
  return fault ? fault->code : ErrorCode::unspecified;
}

TEST(Calls, RolesMayMakeTheirRequests) {
  EXPECT_EQ(verdict(Kind::pause, Role::supervisor), ErrorCode::unspecified);
  EXPECT_EQ(verdict(Kind::status, Role::observer), ErrorCode::unspecified);
  EXPECT_EQ(verdict(Kind::pause, Role::observer), ErrorCode::forbidden);
  EXPECT_EQ(verdict(Kind::status, Role::controller), ErrorCode::forbidden);
  EXPECT_EQ(verdict(Kind::none, Role::supervisor), ErrorCode::bad_value);
  EXPECT_EQ(verdict(Kind::snapshot, Role::supervisor), ErrorCode::unspecified);
  EXPECT_EQ(verdict(Kind::restore, Role::observer), ErrorCode::forbidden);
}

constexpr SessionId first{1}, second{2};

TEST(Calls, AreTakenOnceInTheirOrder) {
  Calls calls;
  EXPECT_FALSE(calls.has_news());
  calls.add(first, "a", request(Kind::pause));
  calls.add(second, "b", request(Kind::status));
  EXPECT_TRUE(calls.has_news());
  const auto taken = calls.take();
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].peer, "a");
  EXPECT_EQ(taken[1].request.kind, Kind::status);
  EXPECT_FALSE(calls.has_news());
  calls.notify();
  EXPECT_TRUE(calls.has_news());
}

TEST(Calls, ASessionHasABoundedNumberUnanswered) {
  Calls calls;
  for (std::size_t i = 0; i < Calls::most_unanswered; ++i) {
    ASSERT_FALSE(calls.add(first, "a", request(Kind::status)));
  }
  EXPECT_EQ(calls.add(first, "a", request(Kind::status))->code, ErrorCode::too_many);
  EXPECT_FALSE(calls.add(second, "b", request(Kind::status))) << "that is another";
  const Call call = calls.take().front();
  calls.answered(call);
  EXPECT_FALSE(calls.add(first, "a", request(Kind::status)));
  EXPECT_TRUE(calls.add(first, "a", request(Kind::status)));
  calls.forget(first);
  EXPECT_FALSE(calls.has_news()) << "what it asked is not answered any more";
  EXPECT_FALSE(calls.add(first, "a", request(Kind::status)));
}

TEST(Calls, UnansweredOnesOfASessionTakeBoundedMemory) {
  Calls calls;
  wire::Request large = request(Kind::spawn);
  large.text.assign(4 * mebibyte, 'x');
  EXPECT_FALSE(calls.add(first, "a", large));
  EXPECT_EQ(calls.add(first, "a", large)->code, ErrorCode::too_many);
  EXPECT_FALSE(calls.add(first, "a", request(Kind::status)));
  EXPECT_FALSE(calls.add(second, "b", large));
  calls.answered(calls.take().front());
  EXPECT_FALSE(calls.add(first, "a", large));
}

TEST(Journal, NoticesArePrintableAndBounded) {
  Journal journal;
  journal.note(std::string(5000, 'x'), {});
  for (int i = 0; i < 150; ++i) journal.note("\x1b[31m" + std::to_string(i) + "\n", {});
  journal.note_other("not hidden by the others", {});
  const Report report = journal.take();
  ASSERT_EQ(report.notices.size(), 21U);
  EXPECT_EQ(report.notices[0].size(), 1000U);
  EXPECT_EQ(report.notices[1], "?[31m0");
  EXPECT_EQ(report.notices.back(), "not hidden by the others");
  EXPECT_TRUE(journal.take().notices.empty());
}

TEST(Journal, LinesAreInSceneOrderAndForgottenWithTheirRobots) {
  Journal journal;
  journal.log() = {{2, false, "c"}, {0, false, "a"}, {1, false, "b"}, {0, true, "a again"}};
  journal.fail(1, "broken", 5);
  journal.fail(0, std::string(100'000, 'x'), 5);
  for (const std::size_t robot : {2, 1, 0}) journal.depart(robot, 5);
  journal.stop("first");
  journal.stop("second");
  journal.shrink(2);
  const Report report = journal.take();
  ASSERT_EQ(report.log.size(), 3U);
  EXPECT_EQ(report.log[1].text, "a again");
  EXPECT_EQ(report.log[2].text, "b");
  EXPECT_EQ(report.failures[0].robot, 0U);
  EXPECT_EQ(report.failures[0].message.size(), 16384U);
  ASSERT_EQ(report.departures.size(), 2U);
  EXPECT_EQ(report.departures[0].robot, 0U);
  EXPECT_EQ(report.stopped, "first");
}

}  // namespace
}  // namespace ziggurat::network

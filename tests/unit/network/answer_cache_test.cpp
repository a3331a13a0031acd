// SPDX-License-Identifier: MIT
// Answers to questions are computed once while nothing changes.

#include "network/answer_cache.h"

#include <gtest/gtest.h>

namespace ziggurat::network {
namespace {

struct AnswerCacheTest : ::testing::Test {
  void ask(std::vector<std::string> entities, const AnswerCache::Version& version) {
    wire::Request request;
    request.kind = wire::Request::Kind::read;
    request.entities = std::move(entities);
    answers.find(request, version, [&](wire::Outbox& outbox) {
      outbox.response(0, wire::Status{});
      ++computed;
    });
  }
  AnswerCache answers;
  int computed = 0;
};

TEST_F(AnswerCacheTest, AreComputedOnceWhileNothingChanges) {
  for (int i = 0; i < 1000; ++i) ask({"*"}, {7, 3});
  // A busy machine may take more than the 100 ms for which an answer holds.
  EXPECT_LE(computed, 100);
  ask({"*"}, {7, 3});
  const int before = computed;
  ask({"*"}, {8, 3});
  EXPECT_EQ(computed, before + 1) << "something has changed";
  ask({"b*"}, {8, 3});
  EXPECT_EQ(computed, before + 2) << "another question";
}

TEST_F(AnswerCacheTest, OfFewQuestionsAreKept) {
  for (int i = 0; i < 20; ++i) ask({std::to_string(i)}, {1, 1});
  EXPECT_EQ(computed, 20);
  ask({"0"}, {1, 1});
  EXPECT_EQ(computed, 21) << "it made place for others";
}

}  // namespace
}  // namespace ziggurat::network

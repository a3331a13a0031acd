#include "sweep/definition.h"

#include <gtest/gtest.h>

#include <functional>

#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

Definition example() {
  return {{"/s.argos", {{Axis::Kind::setting, "a/@b", {"1", "2"}}}, {1, 2}, {"--ticks", "5"}},
          {{"/s.argos", "aa"}, {"/c.lua", "bb"}}};
}

/// What is said when the sweep has changed.
std::string refusal(const std::function<void(Definition&)>& change) {
  Definition now = example();
  change(now);
  try {
    check_same(example(), now, "out");
  } catch (const text::UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Definition, IsReadAsItWasWritten) {
  const Definition read = definition_from_json(to_json(example()), "e.json");
  EXPECT_EQ(to_json(read), to_json(example()));
  EXPECT_NO_THROW(check_same(example(), read, "out"));
}

TEST(Definition, AnotherSweepIsRefusedAndItsDifferenceNamed) {
  EXPECT_EQ(refusal([](Definition&) {}), "");
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(refusal([](Definition& d) { d.experiment.scene = "/t.argos"; }), "its scene is /s.argos");
  has(refusal([](Definition& d) { d.experiment.axes[0].values.pop_back(); }), "it has 'a/@b=1|2'");
  has(refusal([](Definition& d) { d.experiment.seeds = {1}; }), "2 seeds from 1 to 2");
  has(refusal([](Definition& d) { d.experiment.run_arguments.clear(); }), "'--ticks 5'");
  has(refusal([](Definition& d) { d.files["/c.lua"] = "cc"; }), "/c.lua has changed");
  has(refusal([](Definition& d) { d.files.erase("/c.lua"); }), "/c.lua has changed");
}

TEST(Definition, FilesThatAreNoneAreRefused) {
  for (const char* text : {"", "{}", "[]", "{\"format\":2}", "{\"format\":1,\"scene\":3}"}) {
    EXPECT_THROW(definition_from_json(text, "e.json"), text::UsageError) << text;
  }
}

}  // namespace
}  // namespace ziggurat::sweep

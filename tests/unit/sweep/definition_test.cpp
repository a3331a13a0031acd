// SPDX-License-Identifier: MIT
#include "sweep/definition.h"

#include <gtest/gtest.h>

#include <functional>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::sweep {
namespace {

Definition example() {
  return {{"/s.argos", {{Axis::Kind::setting, "a/@b", {"1", "2"}}}, {1, 2}, {"--ticks", "5"}},
          {{"/s.argos", "aa"}, {"/c.lua", "bb"}}};
}

/// Sentence when the sweep has changed.
std::string refusal(const std::function<void(Definition&)>& change) {
  Definition now = example();
  change(now);
  return words_of<text::UsageError>([&] { check_same(example(), now, "out"); });
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
  has(refusal([](Definition& d) { d.experiment.run_arguments.clear(); }),
      "its runs also have the argument '--ticks'");
  has(refusal([](Definition& d) { d.experiment.run_arguments[1] = "6"; }),
      "its runs have '--ticks 5', not '--ticks 6'");
  has(refusal([](Definition& d) { d.experiment.run_arguments.push_back("--lenient"); }),
      "its runs have no argument '--lenient'");
  has(refusal([](Definition& d) { d.files["/c.lua"] = "cc"; }), "/c.lua has changed");
  has(refusal([](Definition& d) { d.files.erase("/c.lua"); }), "/c.lua has changed");
  has(refusal([](Definition& d) { d.files["/b.lua"] = "cc"; }), "/b.lua has changed");
  has(refusal([](Definition& d) { d.files["/z.lua"] = "cc"; }), "/z.lua has changed");
}

TEST(Definition, TheFirstDifferenceIsNamed) {
  Definition kept = example(), now = example();
  for (const char* name : {"/a", "/b", "/x"}) kept.files[name] = "1", now.files[name] = "2";
  const std::string words = words_of<text::UsageError>([&] { check_same(kept, now, "my out"); });
  EXPECT_EQ(words.find("/a has changed"), 0u) << words;
  kept.experiment.axes.push_back({Axis::Kind::parameter, "gain", {"1"}});
  now.experiment.axes.insert(now.experiment.axes.begin(), kept.experiment.axes.back());
  const std::string text = words_of<text::UsageError>([&] { check_same(kept, now, "my out"); });
  EXPECT_NE(text.find("another order: 'a/@b' comes before 'gain'"), text.npos) << text;
  EXPECT_NE(text.find("ziggurat sweep resume 'my out'"), text.npos) << text;
}

TEST(Definition, FilesThatAreNoneAreRefused) {
  for (const char* text : {"", "{}", "[]", "{\"format\":2}", "{\"format\":1,\"scene\":3}"}) {
    EXPECT_THROW(definition_from_json(text, "e.json"), text::UsageError) << text;
  }
}

}  // namespace
}  // namespace ziggurat::sweep

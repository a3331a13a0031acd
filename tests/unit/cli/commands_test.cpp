// SPDX-License-Identifier: MIT
#include "cli/commands.h"

#include <gtest/gtest.h>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::cli {
namespace {

TEST(Commands, EachExplainsItselfWithItsName) {
  for (const auto& command : commands()) {
    const auto text = command.help();
    EXPECT_NE(text.find("usage: ziggurat "), std::string::npos) << command.name;
    EXPECT_NE(help_help().find(command.name), std::string::npos) << command.name;
  }
}

TEST(Commands, MisspeltNamesGetASuggestion) {
  const std::string words = words_of<text::UsageError>([&] { command_named("chekc"); });
  EXPECT_EQ(words, "there is no command 'chekc'; did you mean 'check'?");
}

TEST(Commands, MisspeltOptionsWithoutCommandGetASuggestion) {
  for (const auto& [written, advice] :
       {std::pair("--versio", "did you mean '--version'?"),
        std::pair("--hepl", "did you mean '--help'?"),
        std::pair("--seed", "write: ziggurat COMMAND [OPTION]...")}) {
    EXPECT_TRUE(fails_with<text::UsageError>(advice, [&] { command_named(written); }));
  }
}

}  // namespace
}  // namespace ziggurat::cli

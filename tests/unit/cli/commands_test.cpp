#include "cli/commands.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

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
  try {
    command_named("chekc");
    FAIL();
  } catch (const text::UsageError& error) {
    EXPECT_STREQ(error.what(), "there is no command 'chekc'; did you mean 'check'?");
  }
}

TEST(Commands, MisspeltOptionsWithoutCommandGetASuggestion) {
  for (const auto& [written, advice] :
       {std::pair("--versio", "did you mean '--version'?"),
        std::pair("--hepl", "did you mean '--help'?"),
        std::pair("--seed", "write: ziggurat COMMAND [OPTION]...")}) {
    try {
      command_named(written);
      ADD_FAILURE() << written;
    } catch (const text::UsageError& error) {
      EXPECT_NE(std::string_view(error.what()).find(advice), std::string_view::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace ziggurat::cli

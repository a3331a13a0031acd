// SPDX-License-Identifier: MIT
#include "reports/console.h"

#include <gtest/gtest.h>

namespace ziggurat::reports {
namespace {

TEST(Console, TextsOfPeersHaveNoEffectOnATerminal) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  {
    Console console;
    console.log_line(3, "r\x1b", "\x1b]52;c;aGk=\x07\nnext", false);
    console.log_line(3, "r", "\x1b[2J", true);
    console.notice("peer \x1b[31m left");
    console.fault("because \r");
    console.problem({{}, "a\x1b", {}, "b\x1b"});
    console.result("{\"id\":\"\xc2\x9b\"}");
    console.flush();
  }
  const std::string out = testing::internal::GetCapturedStdout();
  const std::string error = testing::internal::GetCapturedStderr();
  EXPECT_EQ(out,
            "[3 r\\u001b] \\u001b]52;c;aGk=\\u0007\n[3 r\\u001b] next\n{\"id\":\"\\u009b\"}\n");
  EXPECT_EQ(error.find_first_of("\x1b\r"), std::string::npos) << error;
}

TEST(Console, MessagesInJsonHaveNoEffectOnATerminalEither) {
  testing::internal::CaptureStderr();
  {
    Console console({false, true});
    console.fault("bad \u009b31m \u009d0;x\u009c \x7f \u202e \x1b \U000e0041");
  }
  EXPECT_EQ(
      testing::internal::GetCapturedStderr(),
      R"({"severity":"fault","text":"bad \u009b31m \u009d0;x\u009c \u007f \u202e \u001b \udb40\udc41"})"
      "\n");
}

}  // namespace
}  // namespace ziggurat::reports

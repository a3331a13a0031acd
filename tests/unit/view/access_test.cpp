// SPDX-License-Identifier: MIT
// Who may connect, and what for.

#include "view/access.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

namespace ziggurat::view {
namespace {

const Rules local{.host = "127.0.0.1", .token = "0123456789abcdef"};

Permission ask(const Rules& rules, std::string_view host, std::optional<std::string_view> origin,
               std::string_view target) {
  return permission_of(rules, {host, origin, target});
}

TEST(Permission, APageOfThisServerAndAProgramMayLook) {
  EXPECT_EQ(ask(local, "127.0.0.1:8765", {}, "/"), Permission::look);
  EXPECT_EQ(ask(local, "localhost:8765", "http://localhost:8765", "/"), Permission::look);
  EXPECT_EQ(ask(local, "[::1]:8765", "http://[::1]:8765", "/"), Permission::look);
}

TEST(Permission, OtherOriginsNeedTheToken) {
  for (const char* origin : {"https://evil.example", "null", "", "http://127.0.0.1:8766",
                             "https://127.0.0.1:8765", "http://127.0.0.1:8765.evil.example"}) {
    EXPECT_EQ(ask(local, "127.0.0.1:8765", origin, "/"), Permission::refused) << origin;
    EXPECT_EQ(ask(local, "127.0.0.1:8765", origin, "/?token=0123456789abcdef"), Permission::steer);
  }
}

TEST(Permission, AWrongTokenIsNotTheSameAsNone) {
  for (const char* target : {"/?token=", "/?token=0123456789abcde", "/?token=0123456789abcdef0",
                             "/?token=0123456789abcdeX", "/?a=b&token=x"}) {
    EXPECT_EQ(ask(local, "127.0.0.1", {}, target), Permission::refused) << target;
  }
  EXPECT_EQ(ask(local, "127.0.0.1", {}, "/?a=b&token=0123456789abcdef&c"), Permission::steer);
  EXPECT_EQ(ask(local, "127.0.0.1", {}, "/?xtoken=0123456789abcdef"), Permission::look);
}

TEST(Permission, NamesOfWebsitesAreRefusedAlsoWithTheToken) {
  EXPECT_EQ(ask(local, "evil.example:8765", {}, "/?token=0123456789abcdef"), Permission::refused);
  const Rules insecure{.host = "0.0.0.0", .any_host = true, .token = "0123456789abcdef"};
  EXPECT_EQ(ask(insecure, "any.example", {}, "/"), Permission::look);
}

TEST(Permission, AnOpenAddressWithATokenOfTheUserShowsNothingWithout) {
  const Rules open{.host = "0.0.0.0", .look_needs_token = true, .token = "0123456789abcdef"};
  EXPECT_EQ(ask(open, "10.0.0.7:8765", "http://10.0.0.7:8765", "/"), Permission::refused);
  EXPECT_EQ(ask(open, "10.0.0.7:8765", {}, "/?token=0123456789abcdef"), Permission::steer);
}

TEST(Permission, TokensOfOptions) {
  EXPECT_THROW(check_token("short"), text::UsageError);
  EXPECT_THROW(check_token("0123456789 abcdef"), text::UsageError);
  EXPECT_NO_THROW(check_token(random_token()));
  EXPECT_NE(random_token(), random_token());
}

}  // namespace
}  // namespace ziggurat::view

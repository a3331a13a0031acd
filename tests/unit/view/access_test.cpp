// Who may connect, and what for.

#include "view/access.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

namespace ziggurat::view {
namespace {

const Rules local{"127.0.0.1", false, false, "0123456789abcdef"};

Access ask(const Rules& rules, std::string_view host, std::optional<std::string_view> origin,
           std::string_view target) {
  return access_of(rules, {host, origin, target});
}

TEST(Access, APageOfThisServerAndAProgramMayLook) {
  EXPECT_EQ(ask(local, "127.0.0.1:8765", {}, "/"), Access::look);
  EXPECT_EQ(ask(local, "localhost:8765", "http://localhost:8765", "/"), Access::look);
  EXPECT_EQ(ask(local, "[::1]:8765", "http://[::1]:8765", "/"), Access::look);
}

TEST(Access, OtherOriginsNeedTheToken) {
  for (const char* origin : {"https://evil.example", "null", "", "http://127.0.0.1:8766",
                             "https://127.0.0.1:8765", "http://127.0.0.1:8765.evil.example"}) {
    EXPECT_EQ(ask(local, "127.0.0.1:8765", origin, "/"), Access::refused) << origin;
    EXPECT_EQ(ask(local, "127.0.0.1:8765", origin, "/?token=0123456789abcdef"), Access::steer);
  }
}

TEST(Access, AWrongTokenIsNotTheSameAsNone) {
  for (const char* target : {"/?token=", "/?token=0123456789abcde", "/?token=0123456789abcdef0",
                             "/?token=0123456789abcdeX", "/?a=b&token=x"}) {
    EXPECT_EQ(ask(local, "127.0.0.1", {}, target), Access::refused) << target;
  }
  EXPECT_EQ(ask(local, "127.0.0.1", {}, "/?a=b&token=0123456789abcdef&c"), Access::steer);
  EXPECT_EQ(ask(local, "127.0.0.1", {}, "/?xtoken=0123456789abcdef"), Access::look);
}

TEST(Access, NamesOfWebsitesAreRefusedAlsoWithTheToken) {
  EXPECT_EQ(ask(local, "evil.example:8765", {}, "/?token=0123456789abcdef"), Access::refused);
  const Rules insecure{"0.0.0.0", true, false, "0123456789abcdef"};
  EXPECT_EQ(ask(insecure, "any.example", {}, "/"), Access::look);
}

TEST(Access, AnOpenAddressWithATokenOfTheUserShowsNothingWithout) {
  const Rules open{"0.0.0.0", false, true, "0123456789abcdef"};
  EXPECT_EQ(ask(open, "10.0.0.7:8765", "http://10.0.0.7:8765", "/"), Access::refused);
  EXPECT_EQ(ask(open, "10.0.0.7:8765", {}, "/?token=0123456789abcdef"), Access::steer);
}

TEST(Access, TokensOfOptions) {
  EXPECT_THROW(check_token("short"), text::UsageError);
  EXPECT_THROW(check_token("0123456789 abcdef"), text::UsageError);
  EXPECT_NO_THROW(check_token(random_token()));
  EXPECT_NE(random_token(), random_token());
}

}  // namespace
}  // namespace ziggurat::view

// SPDX-License-Identifier: MIT
// Files of the page's folder, and no others.

#include "view/page.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace ziggurat::view {
namespace {

class Folder : public ::testing::Test {
 protected:
  Folder() {
    std::filesystem::create_directories(path_ / "web/assets");
    write("web/index.html", "<html>");
    write("web/assets/page.js", "run()");
    write("web/.hidden", "no");
    write("secret", "no");
  }
  ~Folder() override { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  const std::filesystem::path path_ =
      ::testing::TempDir() + "page_test_" + std::to_string(::getpid());
  const Page page_{(path_ / "web").string()};
};

TEST_F(Folder, HasTypesAndTags) {
  const http::Answer page = page_.get("/?token=x", {});
  EXPECT_EQ(page.status, 200u);
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_EQ(page.body, "<html>");
  const http::Answer script = page_.get("/assets/page.js", {});
  EXPECT_EQ(script.type, "text/javascript; charset=utf-8");
  const http::Answer again = page_.get("/assets/page.js", script.etag);
  EXPECT_EQ(again.status, 304u);
  EXPECT_TRUE(again.body.empty());
  write("web/assets/page.js", "walk()");
  EXPECT_EQ(page_.get("/assets/page.js", script.etag).body, "walk()");
}

TEST_F(Folder, FilesWithTheHashOfTheirContentStay) {
  write("web/page-J3BWKQ0H.js", "run()");
  write("web/page-j3bwkq0h.js", "run()");
  write("web/page-J3BWKQ0HX.js", "run()");
  EXPECT_TRUE(page_.get("/page-J3BWKQ0H.js", {}).is_immutable);
  for (const char* other : {"/page-j3bwkq0h.js", "/page-J3BWKQ0HX.js", "/assets/page.js", "/"}) {
    EXPECT_FALSE(page_.get(other, {}).is_immutable) << other;
  }
}

TEST_F(Folder, HasTheSameInGzip) {
  write("web/assets/page.js.gz", "zip");
  const http::Answer script = page_.get("/assets/page.js", {});
  EXPECT_EQ(script.body, "run()");
  EXPECT_EQ(script.gzipped, "zip");
  EXPECT_TRUE(page_.get("/", {}).gzipped.empty());
}

TEST_F(Folder, IsNotLeft) {
  for (const char* target :
       {"/../secret", "/assets/../../secret", "/..", "//secret", "/.hidden", "/%2e%2e/secret",
        "/assets", "/assets/", "/nothing", "secret", "", "/\\..\\secret"}) {
    const http::Answer answer = page_.get(target, {});
    EXPECT_EQ(answer.status, 404u) << target;
    EXPECT_EQ(answer.body.find("no\n"), std::string::npos);
  }
}

TEST(Page, ThatWasNotBuiltIsAText) {
  const http::Answer answer = Page("/nowhere").get("/", {});
  EXPECT_EQ(answer.status, 200u);
  EXPECT_NE(answer.body.find("not built"), std::string::npos);
  EXPECT_NE(content_security_policy("h:1").find("connect-src 'self' ws://h:1;"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::view

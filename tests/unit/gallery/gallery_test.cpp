// SPDX-License-Identifier: MIT
// Requests to the gallery, without a port. The program that it starts is a script.

#include "gallery/gallery.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gallery/pictures.h"
#include "temporary_folder.h"
#include "waiting.h"

namespace ziggurat::gallery {
namespace {

namespace fs = std::filesystem;

class GalleryTest : public testing::Test {
 protected:
  GalleryTest() {
    ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    fs::create_directories(folder_ / "scenes");
    for (const char* name : {"a", "b<script>"}) {
      std::ofstream(folder_ / "scenes" / (std::string(name) + ".argos"))
          << "<!-- Of <b>" << name << "</b>. --><argos-configuration/>";
    }
    write_program("exit 3");
  }
  void write_program(const std::string& text) {
    std::ofstream(folder_ / "program") << "#!/bin/sh\n" << text << "\n";
    ::chmod((folder_ / "program").c_str(), 0755);
  }
  Settings settings() const {
    Settings settings;
    settings.folder = (folder_ / "scenes").string();
    settings.program = (folder_ / "program").string();
    settings.address = {"127.0.0.1", 0};
    settings.token = "0123456789abcdef";
    return settings;
  }
  const TemporaryFolder folder_;
};

TEST_F(GalleryTest, NothingIsTheirsWithoutToken) {
  Gallery gallery(settings());
  for (const char* path : {"/", "", "/0123456789abcde", "/0123456789abcdeX/", "/0123456789abcdef",
                           "/run/0", "//0123456789abcdef/", "/0123456789ABCDEF/run/0"}) {
    EXPECT_EQ(gallery.answer(path).status, 403u) << path;
  }
}

TEST_F(GalleryTest, ScenesAreNamedByNumbersAlone) {
  Gallery gallery(settings());
  for (const char* rest : {"run/2", "run/-1", "run/", "run/0x0", "run/ 0", "run/0/", "run/+0",
                           "run/..", "run/99999999999999999999999", "picture/../../etc/passwd",
                           "picture/2", "picture/0", "etc/passwd", "..", "wait/", "run"}) {
    const http::Answer answer = gallery.answer(gallery.path() + rest);
    EXPECT_EQ(answer.status, 404u) << rest;
    EXPECT_TRUE(answer.body.starts_with("404: ")) << rest;
  }
}

TEST_F(GalleryTest, TextsOfScenesAreText) {
  Gallery gallery(settings());
  const http::Answer page = gallery.answer(gallery.path());
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_NE(page.body.find("Of &#60;b&#62;a&#60;/b&#62;."), std::string::npos) << page.body;
  EXPECT_NE(page.body.find("<h2>b&#60;script&#62;</h2>"), std::string::npos) << page.body;
  EXPECT_EQ(page.body.find("<script"), std::string::npos);
  EXPECT_NE(page.body.find("http-equiv=\"refresh\""), std::string::npos) << "pictures come";
}

TEST_F(GalleryTest, PicturesAreDrawnOnceAndKept) {
  write_program(
      "[ \"$1\" = render ] && case $2 in *a.argos) echo drawn >\"$4\" ;; *) exit 1 ;; esac");
  Gallery gallery(settings());
  const auto page = [&] { return gallery.answer(gallery.path()).body; };
  ASSERT_TRUE(comes_true([&] {
    gallery.go_on();
    return page().find("drawing") == std::string::npos;
  }));
  const http::Answer picture = gallery.answer(gallery.path() + "picture/0");
  EXPECT_EQ(picture.type, "image/png");
  EXPECT_EQ(picture.body, "drawn\n");
  EXPECT_EQ(gallery.answer(gallery.path() + "picture/1").status, 404u);
  EXPECT_NE(page().find("no picture"), std::string::npos);
  EXPECT_EQ(page().find("http-equiv=\"refresh\""), std::string::npos);

  Gallery again(settings());
  EXPECT_EQ(again.answer(again.path() + "picture/0").body, "drawn\n");
  std::ofstream(folder_ / "scenes/a.argos", std::ios::app) << "<!-- changed -->";
  EXPECT_EQ(Gallery(settings()).answer(again.path() + "picture/0").status, 404u);
}

TEST_F(GalleryTest, OldPicturesAreForgotten) {
  const fs::path cache = folder_ / "pictures";
  fs::create_directories(cache);
  for (int i = 0; i < 5; ++i) {
    const fs::path file = cache / (std::to_string(i) + ".png");
    std::ofstream(file) << i;
    fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::seconds(i));
  }
  forget_old(cache, 2);
  EXPECT_FALSE(fs::exists(cache / "2.png"));
  EXPECT_TRUE(fs::exists(cache / "3.png") && fs::exists(cache / "4.png"));
  forget_old(folder_ / "none", 2);
}

TEST_F(GalleryTest, ARunThatEndsIsTold) {
  Gallery gallery(settings());
  EXPECT_EQ(gallery.answer(gallery.path() + "wait").location, gallery.path()) << "none is there";
  const http::Answer started = gallery.answer(gallery.path() + "run/0");
  EXPECT_EQ(started.status, 303u);
  EXPECT_EQ(started.location, gallery.path() + "wait");
  std::string told;
  ASSERT_TRUE(comes_true([&] {
    gallery.go_on();
    told = gallery.answer(gallery.path() + "wait").body;
    return told.find("is being") == std::string::npos;
  }));
  EXPECT_NE(told.find("The run of a ended with exit code 3"), std::string::npos) << told;
}

/// A program whose runs write their arguments, and wait until they are ended; it draws no pictures.
constexpr const char* waiting =
    "[ \"$1\" = run ] || exit 1; echo \"$@\" >>\"$(dirname \"$0\")/told\"; exec sleep 100";

TEST_F(GalleryTest, ARunTakesThePlaceOfTheOneBefore) {
  write_program(waiting);
  Gallery gallery(settings());
  const auto told = [&] {
    std::ifstream file(folder_ / "told");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  };
  gallery.answer(gallery.path() + "run/0");
  gallery.go_on();
  ASSERT_TRUE(comes_true([&] { return told().size() == 1; }));
  gallery.answer(gallery.path() + "run/1");
  gallery.go_on();
  ASSERT_TRUE(comes_true([&] { return told().size() == 2; }));
  const std::string first = told()[0], second = told()[1];
  EXPECT_NE(first.find("/scenes/a.argos --view=127.0.0.1:"), std::string::npos) << first;
  EXPECT_NE(second.find("/scenes/b<script>.argos --view=127.0.0.1:"), std::string::npos) << second;
  EXPECT_NE(second.find("--view-token 0123456789abcdef"), std::string::npos) << second;
  EXPECT_EQ(second.find("--insecure"), std::string::npos);
  gallery.close();
  EXPECT_EQ(gallery.answer(gallery.path() + "wait").location, gallery.path()) << "none is left";
}

}  // namespace
}  // namespace ziggurat::gallery

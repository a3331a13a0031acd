// Who can change the list of clients' keys.

#include "run/clients_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

namespace fs = std::filesystem;

constexpr uid_t root = 0;

struct ClientsFile : ::testing::Test {
  ClientsFile() {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "";
    ::chmod(file.c_str(), 0600);
  }
  /// Owner of the file: a test that root runs gives it to another user.
  uid_t owner() const {
    constexpr uid_t other = 12345;
    if (::geteuid() != root) return ::geteuid();
    EXPECT_EQ(::chown(file.c_str(), other, static_cast<gid_t>(-1)), 0);
    return other;
  }
  static std::string complaint(const fs::path& path, uid_t user) {
    try {
      check_clients(path.string(), user);
    } catch (const text::UsageError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder;
  fs::path file = folder / "inner" / "clients";
};

TEST_F(ClientsFile, BelongsToTheUserOrToRoot) {
  const uid_t user = owner();
  EXPECT_EQ(complaint(file, user), "");
  EXPECT_EQ(complaint(file, root), "") << "root may read that of any user";
  const std::string text = complaint(file, user + 1);
  EXPECT_NE(text.find("'" + file.string() + "', which belongs to another user"), std::string::npos) << text;
  if (::geteuid() != root) return;
  ASSERT_EQ(::chown(file.c_str(), root, static_cast<gid_t>(-1)), 0);
  EXPECT_EQ(complaint(file, user), "") << "root's";
}

TEST_F(ClientsFile, ALinkIsThatToWhichItLeads) {
  const uid_t user = owner();
  const fs::path link = folder / "link";
  fs::create_symlink(file, link);
  EXPECT_EQ(complaint(link, user), "");
  EXPECT_NE(complaint(link, user + 1).find("belongs to another user"), std::string::npos);
}

TEST_F(ClientsFile, IsWrittenByItsOwnerAlone) {
  const uid_t user = owner();
  for (const mode_t mode : {0620, 0602}) {
    ::chmod(file.c_str(), mode);
    EXPECT_NE(complaint(file, user).find("chmod go-w"), std::string::npos) << mode;
    EXPECT_NE(complaint(file, root).find("chmod go-w"), std::string::npos) << mode;
  }
  ::chmod(file.c_str(), 0644);
  EXPECT_EQ(complaint(file, user), "") << "its keys are public";
}

TEST_F(ClientsFile, StandsInNoFolderThatAllCanWrite) {
  const uid_t user = owner();
  for (const fs::path& open : {file.parent_path(), folder.path}) {
    ::chmod(open.c_str(), 0777);
    EXPECT_NE(complaint(file, user).find("all users can write the folder '" + open.string() + "'"), std::string::npos);
    ::chmod(open.c_str(), 01777);
    EXPECT_EQ(complaint(file, user), "") << "sticky: no user can replace the file of another";
    ::chmod(open.c_str(), 0700);
  }
}

TEST_F(ClientsFile, WhatCannotBeReadIsReportedByItsReader) {
  EXPECT_EQ(complaint("", 1), "");
  EXPECT_EQ(complaint(folder / "nowhere", 1), "");
  EXPECT_EQ(complaint(folder.path, 1), "");
}

TEST(Scopes, ThatMeanNoRobotOfTheSceneAreDoubted) {
  scene::Scene scene;
  scene.controllers.resize(1);
  scene.controllers[0].id = "wander";
  world::Layout layout;
  layout.robots.resize(2);
  layout.robots[0].id = "scout1";
  layout.robots[1].id = "r7";
  network::ClientKey fits{"k", network::all_roles, "Alice", {{"scout*", "r7"}, {"w*"}}};
  network::ClientKey misspelt{"key of 40 characters", network::all_roles, "", {{"zzz*", "r7", "r8"}, {"wonder"}}};
  EXPECT_EQ(doubts_of({fits, misspelt}, scene, layout),
            (std::vector<std::string>{
                "--curve-clients: robots=zzz*,r8 of the key key of 40 characters means no robot of the scene",
                "--curve-clients: controllers=wonder of the key key of 40 characters means no controller of the scene"}));
}

}  // namespace
}  // namespace ziggurat::run

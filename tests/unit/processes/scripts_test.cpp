// SPDX-License-Identifier: MIT
#include "processes/scripts.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "processes/commands.h"
#include "processes/places.h"
#include "processes/private_folder.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

class Scripts : public testing::Test {
 protected:
  fs::path write(const fs::path& name, const std::string& text) {
    const fs::path path = fs::path(folder_.path()) / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path;
  }

  // A scene with one Lua controller that names the script.
  scene::Scene naming(const std::string& script) {
    scene::Scene scene;
    scene.files = {"a.argos"};
    auto& controller = scene.controllers.emplace_back();
    controller.lua = true;
    controller.params = {{"speed", "1"}, {"script", script}};
    controller.params_where = {0, 12, 7};
    return scene;
  }

  PrivateFolder folder_;
};

TEST_F(Scripts, AreFoundBesideTheSceneAndAboveIt) {
  const auto scene = write("a/b/scene.argos", "");
  const auto beside = write("a/b/beside.lua", "");
  const auto above = write("scripts/above.lua", "");
  EXPECT_EQ(find_file("beside.lua", scene, scene), beside);
  EXPECT_EQ(find_file("scripts/above.lua", scene, scene), above);
  EXPECT_EQ(find_file(above.string(), scene, scene), above);
  EXPECT_EQ(find_file("nowhere.lua", scene, scene), std::nullopt);
  EXPECT_EQ(find_file("/nowhere.lua", scene, scene), std::nullopt);
  EXPECT_EQ(find_file("scripts", scene, scene), std::nullopt) << "a folder is no script";
}

TEST_F(Scripts, AreFoundBesideTheFileThatNamesThem) {
  const auto scene = write("a/scene.argos", "");
  const auto models = write("parts/block.argos", "");
  const auto beside = write("parts/block.lua", "");
  const auto nearer = write("parts/both.lua", "");
  const auto of_scene = write("a/both.lua", "");
  EXPECT_EQ(find_file("block.lua", models, scene), beside);
  EXPECT_EQ(find_file("block.lua", scene, scene), std::nullopt);
  EXPECT_EQ(find_file("both.lua", models, scene), nearer);
  EXPECT_EQ(find_file("both.lua", scene, scene), of_scene);
}

TEST_F(Scripts, WorkingDirectoryComesLast) {
  const auto scene = write("a/scene.argos", "");
  const auto beside = write("a/drive.lua", "");
  const auto here = write("b/drive.lua", "");
  const auto only_here = write("b/only.lua", "");
  const auto former = fs::current_path();
  fs::current_path(here.parent_path());
  const auto found = find_file("drive.lua", scene, scene);
  const auto otherwise = find_file("only.lua", scene, scene);
  fs::current_path(former);
  EXPECT_EQ(found, beside);
  EXPECT_EQ(otherwise, only_here);
}

TEST_F(Scripts, TheFolderAboveIsThatOfTheScene) {
  const auto scene = write("a/b/scene.argos", "");
  const auto above = write("a/x.lua", "");
  write("c/x.lua", "");
  fs::create_directories(fs::path(folder_.path()) / "c/d");
  const auto former = fs::current_path();
  fs::current_path(fs::path(folder_.path()) / "c/d");
  const auto found = find_file("../x.lua", scene, scene);
  fs::current_path(former);
  EXPECT_EQ(found, above);
}

TEST_F(Scripts, CommandsAreLookedForInTheSamePlaces) {
  const auto scene = write("a b/scene.argos", "");
  const auto program = write("a b/drive", "#!/bin/sh\n");
  const auto script = write("a b/drive.py", "");
  fs::permissions(program, fs::perms::owner_all);
  const auto find = [&](const char* command) { return find_command(command, scene, scene); };
  const std::string folder = scene.parent_path().string();
  EXPECT_EQ(find("./drive --fast").text, "'" + folder + "/drive' --fast");
  EXPECT_EQ(find("exec ./drive").text, "exec '" + folder + "/drive'");
  EXPECT_EQ(find("sh -e drive.py --out x.csv").text, "sh -e '" + script.string() + "' --out x.csv");
  for (const char* command : {"./drive", "echo hello", "cd /tmp && ./nothing", "X=$A ./nothing",
                              "\"$HOME/x\"", "sh -c 'exec ./nothing'", "sleep 1"}) {
    EXPECT_EQ(find(command).missing, "") << command;
  }
  EXPECT_NE(find("./driv").missing.find("did you mean './drive'?"), std::string::npos)
      << find("./driv").missing;
  EXPECT_NE(find("drive").missing.find("write ./drive"), std::string::npos);
  EXPECT_NE(find("sh nothing.py").missing.find("'nothing.py' is not there"), std::string::npos);
  EXPECT_NE(find("/nothing/there").missing.find("is not there"), std::string::npos);
  EXPECT_NE(find("./drive.py").missing.find("chmod +x"), std::string::npos);
}

TEST_F(Scripts, CommandsBehindOthersQuotedOrInTheSceneFolder) {
  const auto scene = write("a b/scene.argos", "");
  const auto program = write("a b/my drive", "#!/bin/sh\n");
  const auto script = write("a b/my drive.py", "");
  write("a b/drive.py", "");
  fs::permissions(program, fs::perms::owner_all);
  const std::string folder = scene.parent_path().string();
  const std::string found_script = "'" + script.string() + "'",
                    found_program = "'" + program.string() + "'";
  for (const auto& [command, found] : std::vector<std::pair<std::string, std::string>>{
           {"'./my drive' --fast", found_program + " --fast"},
           {"./my\\ drive", found_program},
           {"\"./my drive\"", found_program},
           {"sh 'my drive.py' x", "sh " + found_script + " x"},
           {"/bin/sh \"my drive.py\"", "/bin/sh " + found_script},
           {"nice sh drive.py", "nice sh '" + folder + "/drive.py'"},
           {"nice -n 5 ./my\\ drive", "nice -n 5 " + found_program},
           {"exec env A=1 B='2 3' ./my\\ drive", "exec env A=1 B='2 3' " + found_program},
           {"A=1 timeout -s INT 5 /bin/sh drive.py",
            "A=1 timeout -s INT 5 /bin/sh '" + folder + "/drive.py'"},
           {"sh $ZIGGURAT_SCENE_FOLDER/drive.py", "sh '" + folder + "/drive.py'"},
           {"sh \"${ZIGGURAT_SCENE_FOLDER}/my drive.py\"", "sh " + found_script},
           {"sh -c 'exec drive.py'", "sh -c 'exec drive.py'"}}) {
    const FoundCommand result = find_command(command, scene, scene);
    EXPECT_EQ(result.text, found);
    EXPECT_EQ(result.missing, "") << command;
  }
  for (const char* command : {"nice ./nothing", "env A=1 ./nothing", "A=1 ./nothing",
                              "/bin/sh nothing.py", "'./no thing'", "sh 'no thing.py'",
                              "$ZIGGURAT_SCENE_FOLDER/nothing", "nice no-such-program"}) {
    EXPECT_NE(find_command(command, scene, scene).missing, "") << command;
  }
  for (const char* command :
       {"$ZIGGURAT_SCENE_FOLDERS/x", "sh '$ZIGGURAT_SCENE_FOLDER' y", "sh '", "sh -lc x.sh"}) {
    EXPECT_EQ(find_command(command, scene, scene).missing, "") << command;
    EXPECT_EQ(find_command(command, scene, scene).text, command);
  }
}

TEST_F(Scripts, ACommandThatNoShellCanStartIsTold) {
  const auto program = write("drive", "#!/bin/sh\n");
  const auto plain = write("drive.txt", "");
  fs::permissions(program, fs::perms::owner_all);
  for (const std::string& command : {program.string() + " --fast", "exec " + program.string(),
                                     std::string("sleep 1"), std::string("X=$A ./nothing"),
                                     std::string("cd /tmp && ./nothing"), std::string("exit 4")}) {
    EXPECT_EQ(why_not_started(command), "") << command;
  }
  EXPECT_NE(why_not_started(program.string() + "r").find("did you mean 'drive'?"),
            std::string::npos);
  EXPECT_NE(why_not_started(plain.string()).find("chmod +x"), std::string::npos);
  EXPECT_NE(why_not_started("./").find("is no program"), std::string::npos);
  for (const char* command : {"", " ", "''", "'' --fast", "\"\"", "exec ''"}) {
    EXPECT_EQ(why_not_started(command), "it names no program: its first word is empty") << command;
  }
  EXPECT_NE(why_not_started("no-such-program").find("no program in PATH"), std::string::npos);
}

TEST_F(Scripts, WithoutAFunctionThatRobotsNeedAreDoubted) {
  const auto scene_file = fs::path(folder_.path()) / "a.argos";
  const auto problems = [&](const char* text) {
    write("s.lua", text);
    return check_scripts(naming("s.lua"), scene_file);
  };
  const auto found = problems("function init() end\nfunction steps() end\n");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].severity, scene::Problem::Severity::warning);
  EXPECT_NE(found[0].text.find("no function step()"), std::string::npos) << found[0].text;
  EXPECT_EQ(problems("function step() end").size(), 1u);
  EXPECT_TRUE(problems("init = function() end step = init").empty());
  write("all.lua", "function step() end\n");
  EXPECT_TRUE(problems("require 'all'").empty());
}

TEST_F(Scripts, AMisspeltNameOfTheParameterIsDoubted) {
  scene::Scene scene = naming("good.lua");
  scene.controllers.front().params.back().first = "scrpt";
  const auto problems = check_scripts(scene, fs::path(folder_.path()) / "a.argos");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].severity, scene::Problem::Severity::warning);
  EXPECT_NE(problems[0].text.find("did you mean script=\"…\" by scrpt=\"…\"?"), std::string::npos)
      << problems[0].text;
}

TEST_F(Scripts, GoodOnesAreNoProblem) {
  write("good.lua", "function init() end function step() end");
  EXPECT_TRUE(check_scripts(naming("good.lua"), fs::path(folder_.path()) / "a.argos").empty());
}

TEST_F(Scripts, FaultsCarryTheLineOfParamsAndOfLua) {
  write("bad.lua", "x = 1\nfunction init( end\n");
  const auto problems = check_scripts(naming("bad.lua"), fs::path(folder_.path()) / "a.argos");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].severity, scene::Problem::Severity::fault);
  EXPECT_EQ(problems[0].file, "a.argos");
  EXPECT_EQ(problems[0].where.line, 12u);
  EXPECT_NE(problems[0].text.find("bad.lua:2:"), std::string::npos) << problems[0].text;
}

TEST_F(Scripts, MissingOnesAreFaultsAndNoneIsANotice) {
  const auto scene_file = fs::path(folder_.path()) / "a.argos";
  const auto missing = check_scripts(naming("nowhere.lua"), scene_file);
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0].severity, scene::Problem::Severity::fault);
  EXPECT_NE(missing[0].text.find("'nowhere.lua'"), std::string::npos);
  const auto none = check_scripts(naming(""), scene_file);
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none[0].severity, scene::Problem::Severity::notice);
}

TEST_F(Scripts, ALongNameIsQuotedInPart) {
  std::string words;
  for (int i = 0; i < 1'000'000; ++i) words += "a b ";
  for (const std::string& name : {std::string(3'000'000, 'n'), words}) {
    const auto problems = check_scripts(naming(name), fs::path(folder_.path()) / "a.argos");
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_LT(to_string(problems[0]).size(), 1000u);
    auto external = naming("");
    external.controllers[0].command = "./" + name;
    const auto told = find_commands(external, fs::path(folder_.path()) / "a.argos");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_LT(to_string(told[0]).size(), 1000u);
  }
}

/// Calls it as a user who is not root: of root's files everything can be read.
template <typename Call>
auto without_rights_of_root(Call call) {
  const uid_t user = ::geteuid();
  EXPECT_EQ(::seteuid(user == 0 ? 65534 : user), 0);
  auto result = call();
  EXPECT_EQ(::seteuid(user), 0);
  return result;
}

TEST_F(Scripts, OneThatCannotBeReadSaysWhy) {
  fs::permissions(folder_.path(), fs::perms{0755});
  const auto path = write("secret.lua", "function init() end function step() end");
  fs::permissions(path, fs::perms{0});
  const auto problems = without_rights_of_root(
      [&] { return check_scripts(naming("secret.lua"), fs::path(folder_.path()) / "a.argos"); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_TRUE(to_string(problems[0])
                  .ends_with("script '" + path.string() +
                             "' cannot be read: Permission denied; check its permissions"))
      << to_string(problems[0]);
}

TEST_F(Scripts, BytecodeIsRefused) {
  const auto path = write("code.lua", "\x1bLua rest");
  EXPECT_TRUE(compile_error(path));
}

TEST_F(Scripts, OtherControllersHaveNone) {
  auto external = naming("nowhere.lua"), replaced = naming("nowhere.lua");
  external.controllers[0].lua = false;
  replaced.controllers[0].command = "./drive";
  EXPECT_TRUE(check_scripts(external, "a.argos").empty());
  EXPECT_TRUE(check_scripts(replaced, "a.argos").empty());
}

}  // namespace
}  // namespace ziggurat::processes

// SPDX-License-Identifier: MIT
// The command line of ziggurat-lua, and where it finds scripts.

#include <cstdlib>

#include "program/find_script.h"
#include "program/options.h"
#include "script_fixture.h"
#include "words_of.h"

namespace ziggurat::lua {
namespace {

Request read(std::vector<const char*> arguments, bool is_terminal = false) {
  arguments.insert(arguments.begin(), "ziggurat-lua");
  return read_arguments(static_cast<int>(arguments.size()), arguments.data(), is_terminal);
}

std::string fault_of(std::vector<const char*> arguments) {
  return words_of<std::exception>([&] { read(std::move(arguments)); });
}

Folders below(const std::filesystem::path& folder) {
  return Folders(std::vector<std::filesystem::path>{folder});
}

class Program : public ScriptTest {
 protected:
  Program() {
    ::unsetenv("ZIGGURAT_ENDPOINT");
    ::unsetenv("ZIGGURAT_CONTROLLER");
  }
  ~Program() override {
    ::unsetenv("ZIGGURAT_ENDPOINT");
    ::unsetenv("ZIGGURAT_CONTROLLER");
  }
};

TEST_F(Program, ReadsItsArguments) {
  const auto options = read({"--connect", "tcp://a:1", "--robot", "a*", "--robot", "b", "--script",
                             "x.lua", "--controller", "c", "--name", "n", "--max-memory", "2"})
                           .options;
  EXPECT_EQ(options.endpoint, "tcp://a:1");
  EXPECT_EQ(options.robots, (std::vector<std::string>{"a*", "b"}));
  EXPECT_EQ(options.script, "x.lua");
  EXPECT_EQ(options.controller, "c");
  EXPECT_EQ(options.name, "n");
  EXPECT_EQ(options.max_memory, std::size_t{2} << 20);
  EXPECT_FALSE(options.echo);
}

TEST_F(Program, AScriptHas256MebibytesUnlessTold) {
  EXPECT_EQ(read({"--connect", "tcp://a:1"}).options.max_memory, std::size_t{256} << 20);
}

TEST_F(Program, ReadsMissingOptionsFromTheEnvironment) {
  ::setenv("ZIGGURAT_ENDPOINT", "tcp://e:1", 1);
  ::setenv("ZIGGURAT_CONTROLLER", "drive", 1);
  EXPECT_EQ(read({}).options.endpoint, "tcp://e:1");
  EXPECT_EQ(read({}).options.controller, "drive");
  EXPECT_EQ(read({"--connect", "tcp://a:1"}).options.endpoint, "tcp://a:1");
  EXPECT_EQ(read({"--robot", "r0"}).options.controller, "");
}

TEST_F(Program, EchoesOnATerminalUnlessQuiet) {
  EXPECT_TRUE(read({"--connect", "x"}, true).options.echo);
  EXPECT_FALSE(read({"--connect", "x", "--quiet"}, true).options.echo);
  EXPECT_TRUE(read({"--connect", "x", "--echo"}).options.echo);
}

TEST_F(Program, ReadsRobotsFromAFile) {
  write("robots", "r0\n\n  r1 \r\nr2");
  const auto path = (folder() / "robots").string();
  EXPECT_EQ(read({"--connect", "x", "--robots-file", path.c_str()}).options.robots,
            (std::vector<std::string>{"r0", "r1", "r2"}));
  write("robots", "\n");
  EXPECT_NE(fault_of({"--connect", "x", "--robots-file", path.c_str()}).find("no robot"),
            std::string::npos);
  EXPECT_NE(fault_of({"--connect", "x", "--robots-file", "/no/such"}).find("can't be read"),
            std::string::npos);
}

TEST_F(Program, ReportsWrongArguments) {
  EXPECT_NE(fault_of({}).find("server"), std::string::npos);
  EXPECT_NE(fault_of({"--connect", "x", "--bogus"}).find("bogus"), std::string::npos);
  EXPECT_NE(fault_of({"--connect", "x", "stray"}).find("--help"), std::string::npos);
  for (const char* memory : {"0", "-1", "x", "1x", "", "99999999999999999999"}) {
    EXPECT_NE(fault_of({"--connect", "x", "--max-memory", memory}), "") << memory;
    EXPECT_NE(fault_of({"--connect", "x", "--max-instructions", memory}), "") << memory;
    EXPECT_NE(fault_of({"--connect", "x", "--max-time", memory}), "") << memory;
  }
}

TEST_F(Program, HasAHelpText) {
  const auto text = read({"--help"}).text;
  for (const char* part : {"--connect", "--robots-file", "Exit codes", "ziggurat serve"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(read({"--version"}).text.substr(0, 13), "ziggurat-lua ");
}

TEST_F(Program, FindsTheServersScript) {
  write("main.lua", "");
  const auto path = (folder() / "main.lua").string();
  const Folders folders = below(folder());
  EXPECT_EQ(find_script(path, {{"script", "other.lua"}}, {folders}).path, path);
}

TEST_F(Program, RunsNoScriptOutsideItsFoldersThoughTheServerNamesIt) {
  write("main.lua", "");
  std::filesystem::create_directory(folder() / "inside");
  std::filesystem::create_symlink(folder() / "main.lua", folder() / "inside/link.lua");
  const Folders inside = below(folder() / "inside");
  for (const auto& path :
       {folder() / "main.lua", folder() / "inside/../main.lua", folder() / "inside/link.lua"}) {
    const auto found = find_script(path.string(), {}, {inside});
    EXPECT_TRUE(found.path.empty()) << path;
    EXPECT_NE(found.fault.find("allow its folder with --script-folder DIR"), std::string::npos);
    EXPECT_TRUE(find_script("", {{"script", path.string()}}, {inside}).path.empty()) << path;
  }
}

TEST_F(Program, TellsAServerNotWhetherAFileExists) {
  write("main.lua", "");
  std::filesystem::create_directory(folder() / "inside");
  const Folders inside = below(folder() / "inside");
  const auto fault_of = [&](const std::string& name) {
    const std::string path = (folder() / name).string();
    const std::string fault = find_script(path, {}, {inside}).fault;
    EXPECT_TRUE(fault.starts_with(path + ": ")) << fault;
    return fault.substr(path.size());
  };
  EXPECT_EQ(fault_of("main.lua"), fault_of("none.lua"));
}

TEST_F(Program, TellsPeopleHereAndNotAServerWhereItLooked) {
  const FoundScript found =
      find_script("/elsewhere/main.lua", {{"script", "no/main.lua"}}, {below(folder())});
  const std::string looked_below = std::filesystem::canonical(folder()).string();
  EXPECT_EQ(found.fault.find(looked_below), std::string::npos) << found.fault;
  EXPECT_NE(found.where.find(looked_below), std::string::npos) << found.where;
}

TEST_F(Program, RunsOnlyFilesThatAreNamedAsScriptsUnlessAFolderIsAllowed) {
  write("netrc", "machine example.com login me password secret");
  const std::string path = (folder() / "netrc").string();
  const Folders folders = below(folder());
  EXPECT_TRUE(find_script(path, {{"script", path}}, {folders}).path.empty());
  EXPECT_EQ(find_script(path, {}, {folders, true}).path, path);
  EXPECT_FALSE(read({"--connect", "x", "--script", "/a/b.lua"}).options.names_any_ending);
  EXPECT_TRUE(read({"--connect", "x", "--script-folder", "/c"}).options.names_any_ending);
}

TEST_F(Program, AllowsItsWorkingDirectoryAndTheFolderOfItsScript) {
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(read({"--connect", "x"}).options.folders, (Paths{"."}));
  EXPECT_EQ(read({"--connect", "x", "--script", "/a/b.lua"}).options.folders, (Paths{".", "/a"}));
  EXPECT_EQ(read({"--connect", "x", "--script-folder", "/c"}).options.folders, (Paths{"/c"}));
  const Exceptions exceptions =
      read({"--connect", "x", "--read-only-file", "a", "--hidden-file", "b", "--curve-secret", "c"})
          .options.exceptions;
  EXPECT_EQ(exceptions.read_only, (Paths{"a"}));
  EXPECT_EQ(exceptions.hidden, (Paths{"b", "c"}));
  EXPECT_THROW(below(folder() / "none"), std::runtime_error);
}

TEST_F(Program, LimitsInstructionsUnlessScriptsAreTrusted) {
  EXPECT_EQ(read({"--connect", "x"}).options.max_instructions, 1'000'000'000u);
  EXPECT_EQ(read({"--connect", "x", "--trust-scripts"}).options.max_instructions, 0u);
  EXPECT_EQ(read({"--connect", "x", "--trust-scripts", "--max-instructions", "3"})
                .options.max_instructions,
            3'000'000u);
}

TEST_F(Program, LimitsProcessorTimeUnlessScriptsAreTrusted) {
  EXPECT_EQ(read({"--connect", "x"}).options.max_computing, 20u);
  EXPECT_EQ(read({"--connect", "x", "--trust-scripts"}).options.max_computing, 0u);
  EXPECT_EQ(read({"--connect", "x", "--trust-scripts", "--max-time", "3"}).options.max_computing,
            3u);
}

TEST_F(Program, FindsTheScriptFromTheWorkingDirectory) {
  write("main.lua", "");
  const auto relative = std::filesystem::proximate(folder() / "main.lua").string();
  EXPECT_EQ(
      find_script("/elsewhere/main.lua", {{"speed", "1"}, {"script", relative}}, {below(folder())})
          .path,
      relative);
}

TEST_F(Program, NamesThePathsOfAMissingScript) {
  const auto found = find_script("/elsewhere/main.lua", {{"script", "no/main.lua"}}, {below(".")});
  EXPECT_TRUE(found.path.empty());
  EXPECT_NE(found.fault.find("/elsewhere/main.lua"), std::string::npos);
  EXPECT_NE(found.fault.find("'no/main.lua'"), std::string::npos);
  EXPECT_NE(find_script("", {}, {below(".")}).fault.find("--script"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::lua

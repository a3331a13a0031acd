// SPDX-License-Identifier: MIT
// Limits of a script that is not trusted.

#include <sys/resource.h>

#include <fstream>
#include <iterator>

#include "script_fixture.h"

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

/// The most memory that this process had [bytes].
std::size_t peak_rss() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<std::size_t>(used.ru_maxrss) << 10;
}

/// A script in <test folder>/inside, which may use the files of that folder.
class Sandbox : public ScriptTest {
 protected:
  Sandbox() {
    fs::create_directory(folder() / "inside");
    write("secret.txt", "secret");
    write("secret.lua", "return 'secret'");
    write("inside/data.txt", "data");
    write("inside/part.lua", "return 'part'");
    write("inside/.hidden", "secret");
    fs::create_symlink(folder() / "secret.txt", folder() / "inside/link.txt");
    fs::create_symlink(folder(), folder() / "inside/up");
    fs::create_symlink(folder() / "new.txt", folder() / "inside/dangling.txt");
    folders_.emplace(std::vector<fs::path>{folder() / "inside"});
    options_.folders = &*folders_;
  }

  /// Value of an expression in a script, with IN and OUT: the folder and the one above.
  std::string value(const std::string& expression) {
    const auto lines = logged("local OUT = '" + folder().string() +
                              "/' local IN = OUT .. 'inside/' log((" + expression + "))");
    return lines.empty() ? "(nothing)" : lines.at(0);
  }
  void expect_refused(const std::string& statement) {
    const std::string text = value("(function() local ok, why = pcall(function() " + statement +
                                   " end) return ok and 'REACHED' or why end)()");
    EXPECT_EQ(text.find("REACHED"), std::string::npos) << statement;
  }

  std::optional<Folders> folders_;
};

TEST_F(Sandbox, StartsNoProgramAndLoadsNoLibrary) {
  for (const char* statement :
       {"os.execute('true')", "io.popen('true')", "package.loadlib('libc.so.6', 'system')",
        "io.tmpfile()", "os.tmpname()", "os.exit(0)", "debug.getregistry()", "debug.sethook()",
        "debug.getupvalue(io.open, 1)", "debug.setmetatable(1, {})",
        "debug.upvaluejoin(print, 1, print, 1)"}) {
    expect_refused(statement);
  }
  EXPECT_NE(value("select(2, pcall(os.execute, 'true'))").find("--trust-scripts"),
            std::string::npos);
  EXPECT_EQ(value("#package.searchers"), "2");
  expect_refused("package.cpath = '/usr/lib/x86_64-linux-gnu/lua/5.3/?.so' require 'lfs'");
  EXPECT_EQ(value("os.getenv('PATH')"), "nil");
}

TEST_F(Sandbox, LoadsNoByteCode) {
  const std::string code = "local code = string.dump(function() return 1 end) ";
  for (const char* mode : {"", ", nil, 'b'", ", nil, 'bt'", ", nil, nil", ", nil, 'x'"}) {
    expect_refused(code + "return assert(load(code" + std::string(mode) + "))()");
  }
  expect_refused(code +
                 "local n = 0 return assert(load(function() n = n + 1 "
                 "return n == 1 and code or nil end, 'x', 'b'))()");
  expect_refused(code +
                 "local f = assert(io.open(IN .. 'c.bin', 'wb')) f:write(code) f:close() "
                 "assert(loadfile(IN .. 'c.bin', 'b'))");
  expect_refused(code +
                 "local f = assert(io.open(IN .. 'c.bin', 'wb')) f:write(code) f:close() "
                 "dofile(IN .. 'c.bin')");
  expect_refused(code +
                 "local f = assert(io.open(IN .. 'c.bin', 'wb')) f:write(code) f:close() "
                 "package.path = IN .. '?.bin' require 'c'");
  EXPECT_EQ(value("load('return 7')()"), "7");
  EXPECT_EQ(value("load('return x', 'c', 't', {x = 8})()"), "8");
  EXPECT_EQ(value("select('#', load('return 7', 'c', 'bt'))"), "1");
}

// Lua's own functions, which those of the sandbox call, are on the stack while scripts are called
// back.
TEST_F(Sandbox, TakesNoFunctionFromTheStack) {
  EXPECT_EQ(
      value("(function() local own load(function() own = own or debug.getinfo(2, 'f').func end) "
            "return tostring(own) end)()"),
      "nil");
  expect_refused(
      "local own "
      "xpcall(function() io.open(IN .. 'data.txt', 'no mode') end, function() "
      "  for level = 1, 9 do "
      "    local info = debug.getinfo(level) "
      "    local ok, file = pcall(info and info.func, '/etc/passwd') "
      "    if ok and io.type(file) == 'file' then own = file end "
      "  end "
      "end) "
      "return assert(own, 'refused')");
  EXPECT_EQ(value("tostring(debug.getinfo(print).func)"), "nil");
  EXPECT_EQ(value("debug.getinfo(1, 'l').currentline"), "1");
  EXPECT_EQ(value("debug.getinfo(1, 'S').what"), "main");
  EXPECT_EQ(value("tostring(debug.getinfo(99))"), "nil");
  EXPECT_EQ(value("debug.getinfo(coroutine.create(print), print, 'S').what"), "C");
}

// In Lua 5.3 the option '>' pops a value from the stack of any coroutine, below its end, too.
TEST_F(Sandbox, EmptiesNoStack) {
  const std::string taken_away =
      "(function() local own = coroutine.create(function() return coroutine.yield() end) "
      "coroutine.resume(own) "
      "for _ = 1, 100000 do pcall(debug.getinfo, own, 0, '>S') end "
      "return select(2, coroutine.resume(own, 'kept')) end)()";
  EXPECT_EQ(value(taken_away), "kept");
  EXPECT_EQ(value("tostring(pcall(debug.getinfo, 1, '>S'))"), "false");
  EXPECT_EQ(value("tostring(pcall(debug.getinfo, print, '>S'))"), "false");
}

TEST_F(Sandbox, AnErrorAboutTheNilOfIoOpenSaysWhyThereIsNone) {
  const std::string opens = "local f = io.open('" + (folder() / "secret.txt").string() + "') ";
  const Failure failure = start(opens + "f:read('a')");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("attempt to index a nil value (local 'f'): io.open has returned nil: '"),
            std::string::npos)
      << *failure;
  EXPECT_NE(failure->find("is not a file that scripts may use this way"), std::string::npos)
      << *failure;
  const Failure missing =
      start("local f = io.open('" + (folder() / "inside/none.txt").string() + "') f:read('a')");
  EXPECT_NE(missing->find("none.txt: No such file or directory"), std::string::npos) << *missing;
  const Failure other = start(opens + "f = io.open('" + (folder() / "inside/data.txt").string() +
                              "') local x x.y = 1");
  EXPECT_EQ(other->find("io.open"), std::string::npos) << *other;
}

TEST_F(Sandbox, OpensNoFileOutsideItsFolders) {
  for (const char* name :
       {"OUT .. 'secret.txt'", "'/etc/passwd'", "IN .. '../secret.txt'", "IN .. 'link.txt'",
        "IN .. 'up/secret.txt'", "IN .. '.hidden'", "'/proc/self/environ'", "'/dev/tty'", "''",
        "IN", "IN .. 'link.txt\\0data.txt'", "IN .. 'none/../../secret.txt'"}) {
    const std::string file = name;
    expect_refused("assert(io.open(" + file + "))");
    expect_refused("for line in io.lines(" + file + ") do end");
    expect_refused("io.input(" + file + ")");
    expect_refused("assert(loadfile(" + file + "))");
    expect_refused("dofile(" + file + ")");
    expect_refused("assert(os.remove(" + file + "))");
    expect_refused("assert(os.rename(" + file + ", IN .. 'moved.txt'))");
  }
  for (const char* name : {"OUT .. 'new.txt'", "IN .. 'dangling.txt'", "IN .. 'up/new.txt'"}) {
    const std::string file = name;
    expect_refused("assert(io.open(" + file + ", 'w'))");
    expect_refused("io.output(" + file + ")");
    expect_refused("assert(os.rename(IN .. 'data.txt', " + file + "))");
  }
  EXPECT_FALSE(fs::exists(folder() / "new.txt"));
  expect_refused("assert(os.rename(IN .. 'up', IN .. 'elsewhere.txt'))");
}

TEST_F(Sandbox, RequiresNoModuleOutsideItsFolders) {
  expect_refused("package.path = OUT .. '?.lua' require 'secret'");
  expect_refused("package.path = IN .. 'up/?.lua' require 'secret'");
  expect_refused("assert(package.searchpath('secret', OUT .. '?.lua'))");
  EXPECT_EQ(value("(function() package.path = IN .. '?.lua' return require 'part' end)()"), "part");
  EXPECT_EQ(value("package.searchpath('part', IN .. '?.lua') == IN .. 'part.lua'"), "1");
}

// Memory outside of Lua's is not counted.
TEST_F(Sandbox, LongNamesTakeLittleMemory) {
  const std::size_t before = peak_rss();
  expect_refused("require(('a'):rep(1 << 20))");
  expect_refused("package.path = ('?;'):rep(1 << 20) require(('q'):rep(1000))");
  expect_refused("package.path = ('?'):rep(1 << 20) require(('q'):rep(1000))");
  expect_refused("package.path = ('x'):rep(1 << 20) require 'q'");
  expect_refused("assert(package.searchpath(('.'):rep(4000), '?', '.', ('x'):rep(1 << 20)))");
  for (const char* call : {"assert(io.open(long))", "assert(io.open(long, 'w'))", "io.lines(long)",
                           "dofile(long)", "assert(os.remove(long))"}) {
    expect_refused(std::string("local long = IN .. ('a/'):rep(1 << 22) ") + call);
  }
  EXPECT_LT(peak_rss() - before, std::size_t{200} << 20);
  EXPECT_EQ(value("(function() package.path = IN .. '?.lua' return require 'part' end)()"), "part");
}

TEST_F(Sandbox, ReadsAndWritesInItsFolders) {
  EXPECT_EQ(value("io.open(IN .. 'data.txt'):read('a')"), "data");
  EXPECT_EQ(value("io.lines(IN .. 'data.txt')()"), "data");
  EXPECT_EQ(value("loadfile(IN .. 'part.lua')()"), "part");
  EXPECT_EQ(value("dofile(IN .. 'part.lua')"), "part");
  ASSERT_EQ(start("local IN = '" + (folder() / "inside/").string() +
                  "' local f = assert(io.open(IN .. 'out.csv', 'w')) f:write('1,2') f:close() "
                  "assert(os.rename(IN .. 'out.csv', IN .. 'kept.csv')) "
                  "assert(os.remove(IN .. 'data.txt'))"),
            std::nullopt);
  std::ifstream kept(folder() / "inside/kept.csv");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), "1,2");
  EXPECT_FALSE(fs::exists(folder() / "inside/data.txt"));
}

TEST_F(Sandbox, ChangesNoProgramsAndScripts) {
  write("inside/drive", "#!/bin/sh");
  fs::permissions(folder() / "inside/drive", fs::perms::owner_all);
  write("inside/drive.txt", "#!/bin/sh");
  fs::permissions(folder() / "inside/drive.txt", fs::perms::owner_all);
  for (const char* name : {"drive", "drive.txt", "part.lua", "new.lua", "scene.argos", "drive.js",
                           "part.pyc", "sweep.toml", "new.LUA", "scene.Argos"}) {
    expect_refused("assert(io.open(IN .. '" + std::string(name) + "', 'a'))");
    expect_refused("assert(os.rename(IN .. 'data.txt', IN .. '" + std::string(name) + "'))");
  }
  expect_refused("assert(io.open(IN .. 'part.lua', 'r+'))");
}

// They would run when the folder is next worked in.
TEST_F(Sandbox, WritesNothingThatOtherProgramsTakeForInstructions) {
  write("inside/Makefile", "all:");
  fs::create_symlink(folder() / "inside/Makefile", folder() / "inside/make.txt");
  for (const char* name : {"Makefile",
                           "make.txt",
                           "Dockerfile",
                           "x.pth",
                           "a.desktop",
                           "x.ps1",
                           "x.bat",
                           "x.R",
                           "x.el",
                           "x.service",
                           "x.mk",
                           "x.cmake",
                           "x.yaml",
                           "x.ini",
                           "x.html",
                           "x.svg",
                           "new",
                           "x.csv.",
                           "x.csv ",
                           "x. ",
                           "CMakeLists.txt",
                           "CMakeCache.txt",
                           "cmakelists.TXT",
                           "CMakePresets.json",
                           "package.json",
                           "package-lock.json",
                           "tsconfig.json",
                           "babel.config.json",
                           "requirements.txt",
                           "requirements-dev.txt",
                           "compile_commands.json",
                           "settings.json",
                           "kernel.json",
                           "composer.json",
                           "cdk.json",
                           "npm-shrinkwrap.json",
                           "wrangler.json",
                           "tauri.conf.json",
                           "app.json",
                           "results.json",
                           "X.JSON"}) {
    const std::string file = "IN .. '" + std::string(name) + "'";
    expect_refused("assert(io.open(" + file + ", 'w'))");
    expect_refused("io.output(" + file + ")");
    expect_refused("assert(os.rename(IN .. 'data.txt', " + file + "))");
    expect_refused("assert(os.remove(" + file + "))");
  }
  EXPECT_EQ(value("io.open(IN .. 'Makefile'):read('a')"), "all:");
  const std::string why = value("select(2, io.open(IN .. 'x.py', 'w'))");
  EXPECT_NE(why.find("end with .csv .tsv .txt"), std::string::npos) << why;
  EXPECT_NE(why.find("--trust-scripts"), std::string::npos) << why;
}

TEST_F(Sandbox, WritesData) {
  for (const char* name :
       {"a.csv", "A.CSV", "b.tsv", "c.txt", "d.log", "e.dat", "results.jsonl", "f.jsonl", "g.bin",
        "h.data", "picture.ppm", "i.csv.tmp", "robot.1.csv"}) {
    EXPECT_EQ(value("io.type(io.open(IN .. '" + std::string(name) + "', 'w'))"), "file") << name;
  }
}

TEST_F(Sandbox, ChangesNoFilesThatAreReadOnlyAndUsesNoneThatAreHidden) {
  write("inside/arms.txt", "<scene/>");
  write("inside/key.txt", "key");
  fs::create_hard_link(folder() / "inside/arms.txt", folder() / "inside/other.txt");
  fs::create_symlink(folder() / "inside/key.txt", folder() / "inside/other_key.txt");
  folders_.emplace(
      std::vector<fs::path>{folder() / "inside"},
      Exceptions{{folder() / "inside/../inside/arms.txt"}, {folder() / "inside/key.txt"}});
  EXPECT_EQ(value("io.open(IN .. 'arms.txt'):read('a')"), "<scene/>");
  for (const char* name : {"arms.txt", "other.txt"}) {
    expect_refused("assert(io.open(IN .. '" + std::string(name) + "', 'r+'))");
    expect_refused("assert(os.remove(IN .. '" + std::string(name) + "'))");
    expect_refused("assert(os.rename(IN .. 'data.txt', IN .. '" + std::string(name) + "'))");
  }
  for (const char* name : {"key.txt", "other_key.txt"}) {
    expect_refused("assert(io.open(IN .. '" + std::string(name) + "'))");
    expect_refused("io.lines(IN .. '" + std::string(name) + "')");
    expect_refused("assert(select(2, loadfile(IN .. '" + std::string(name) + "')):find('near'))");
  }
}

TEST_F(Sandbox, HidesTheMetatableOfFiles) {
  EXPECT_EQ(value("getmetatable(io.stdout)"), "0");
  EXPECT_EQ(value("io.stdout.__index"), "nil");
  EXPECT_EQ(value("io.stdout.__gc"), "nil");
  EXPECT_EQ(value("type(io.stdout.write)"), "function");
}

TEST_F(Sandbox, HasNoFinalizers) {
  expect_refused("setmetatable({}, {__gc = function() while true do end end})");
  EXPECT_EQ(value("setmetatable({}, {__index = {x = 5}}).x"), "5");
  EXPECT_EQ(value("pcall(setmetatable, setmetatable({}, {__metatable = 1}), {})"), "0");
}

TEST_F(Sandbox, TrustedScriptsHaveAllOfLua) {
  options_.folders = nullptr;
  EXPECT_EQ(value("os.execute('true')"), "1");
  EXPECT_EQ(value("io.open(OUT .. 'secret.txt'):read('a')"), "secret");
  EXPECT_EQ(value("type(debug.getregistry())"), "table");
  EXPECT_EQ(value("type(debug.getinfo(print).func)"), "function");
}

TEST_F(Sandbox, HasABoundedNumberOfOpenFiles) {
  EXPECT_EQ(
      value("(function() local n, file, why = 0 OPEN = {} repeat file, why = io.open(IN .. "
            "'data.txt') n = n + 1 "
            "OPEN[n] = file until not file return n .. ' ' .. why end)()")
          .substr(0, 60),
      ("33 '" + folder().string() + "/inside/data.txt' is not opened: this script has 32 files")
          .substr(0, 60));
  EXPECT_NE(
      value(
          "(function() OPEN = {} for i = 1, 40 do OPEN[i] = io.lines(IN .. 'data.txt') end end)()")
          .find("has 32 files open"),
      std::string::npos);
  EXPECT_NE(value("(function() OPEN = {} for i = 1, 40 do io.input(IN .. 'data.txt') OPEN[i] = "
                  "io.input() end end)()")
                .find("has 32 files open"),
            std::string::npos);
}

TEST_F(Sandbox, OpensMoreFilesAfterItClosedOrForgotOthers) {
  EXPECT_EQ(value("(function() for i = 1, 1000 do assert(io.open(IN .. 'data.txt')):close() end "
                  "for i = 1, 1000 do assert(io.open(IN .. 'data.txt')) end "
                  "for i = 1, 1000 do for line in io.lines(IN .. 'data.txt') do end end return "
                  "'all' end)()"),
            "all");
}

}  // namespace
}  // namespace ziggurat::lua

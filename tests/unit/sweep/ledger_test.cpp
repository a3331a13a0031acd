// SPDX-License-Identifier: MIT
#include "sweep/ledger.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <type_traits>

#include "sweep/folder.h"
#include "temporary_folder.h"
#include "words_of.h"

namespace ziggurat::sweep {
namespace {

class LedgerTest : public testing::Test {
 protected:
  /// The first value of the first row, as text.
  std::string ask(const std::string& sql) const {
    sqlite3* database = nullptr;
    sqlite3_open(path_.c_str(), &database);
    std::string answer;
    const auto keep = [](void* to, int, char** values, char**) {
      if (values[0]) *static_cast<std::string*>(to) = values[0];
      return 1;
    };
    sqlite3_exec(database, sql.c_str(), keep, &answer, nullptr);
    sqlite3_close(database);
    return answer;
  }

  const Experiment experiment_{
      "/s.argos", {{Axis::Kind::parameter, "gain", {"0.5", "it's"}}}, {1, 2}, {}};
  TemporaryFolder folder_;
  std::string path_ = folder_ / "sweep.sqlite";
};

TEST(FileOfASweep, IsNotWrittenThroughALinkAtThePlaceOfItsDraft) {
  const TemporaryFolder folder;
  std::ofstream(folder / "precious") << "kept";
  std::filesystem::create_symlink(folder / "precious",
                                  folder / ("job.yaml." + std::to_string(::getpid()) + ".new"));
  write_file(folder / "job.yaml", "a manifest");
  EXPECT_EQ(read_file(folder / "precious"), "kept");
  EXPECT_EQ(read_file(folder / "job.yaml"), "a manifest");
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "job.yaml"));
}

Result full() {
  Result result;
  result.run = 3;
  result.seed = (std::uint64_t{1} << 63) - 1;
  result.outcome = Outcome::timed_out;
  result.exit_code = 143;
  result.ending = "interrupted";
  result.ticks = 17;
  result.simulated_s = 0.1;
  result.hash = "0123456789abcdef";
  result.robots = 4;
  result.worst_residual = 1e-300;
  result.metrics = {{"a", 0.1}, {"b", -3}};
  result.wall_s = 2.5;
  result.version = "0.1.0";
  return result;
}

TEST_F(LedgerTest, ReadsWhatWasWritten) {
  Ledger(path_).write(full(), experiment_);
  const auto results = Ledger(path_).read();
  ASSERT_EQ(results.size(), 1u);
  const Result& r = results[0];
  const Result e = full();
  EXPECT_EQ(std::tie(r.run, r.seed, r.outcome, r.exit_code, r.ending, r.ticks, r.simulated_s,
                     r.hash, r.robots),
            std::tie(e.run, e.seed, e.outcome, e.exit_code, e.ending, e.ticks, e.simulated_s,
                     e.hash, e.robots));
  EXPECT_EQ(std::tie(r.failures, r.worst_residual, r.metrics, r.wall_s, r.version),
            std::tie(e.failures, e.worst_residual, e.metrics, e.wall_s, e.version));
}

TEST_F(LedgerTest, ARunIsThereOnce) {
  Ledger ledger(path_);
  ledger.write(full(), experiment_);
  Result again;
  again.run = 3;
  again.metrics = {{"c", 1}};
  ledger.write(again, experiment_);
  const auto results = ledger.read();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].outcome, Outcome::finished);
  EXPECT_EQ(results[0].metrics, (std::map<std::string, double>{{"c", 1}}));
}

TEST_F(LedgerTest, TheViewHasAColumnPerAxisAndMetric) {
  Ledger ledger(path_);
  ledger.write(full(), experiment_);
  Result first;
  first.run = 1;
  ledger.write(first, experiment_);
  ledger.make_view(experiment_);
  ledger.make_view(experiment_);
  EXPECT_EQ(ask("SELECT gain || ' ' || a || ' ' || ticks FROM results WHERE run = 3"),
            "it's 0.1 17");
  EXPECT_EQ(ask("SELECT typeof(gain) FROM results WHERE run = 1"), "real");
}

TEST_F(LedgerTest, TheViewHasManyAxesAndAsManyMetricsAsItCan) {
  Experiment experiment{"/s.argos", {}, {1}, {}};
  for (int i = 0; i < 100; ++i) {
    experiment.axes.push_back(
        {Axis::Kind::parameter, "axis" + std::to_string(i), {std::to_string(i)}});
  }
  Result result;
  result.run = 1;
  result.hash = "00ff";
  result.version = "1.0";
  for (int i = 1000; i < 4000; ++i) result.metrics["m" + std::to_string(i)] = i;
  Ledger ledger(path_);
  ledger.write(result, experiment);
  ledger.make_view(experiment);
  EXPECT_EQ(ask("SELECT (axis0 + axis99 + m1000) || ' ' || hash || ' ' || version FROM results"),
            "1099.0 00ff 1.0");
  EXPECT_EQ(ask("SELECT count(*) FROM pragma_table_info('results')"), "2000");
  EXPECT_EQ(ask("SELECT count(*) FROM metrics"), "3000");
}

TEST_F(LedgerTest, TheViewHasMetricsThatDifferInCase) {
  Result result;
  result.run = 1;
  result.metrics = {{"Load", 1}, {"load", 2}};
  Ledger ledger(path_);
  ledger.write(result, experiment_);
  ledger.make_view(experiment_);
  EXPECT_EQ(ask("SELECT load || ' ' || metric_load FROM results"), "1.0 2.0");
}

static_assert(!std::is_move_constructible_v<Ledger> && !std::is_copy_constructible_v<Ledger>);

TEST_F(LedgerTest, AFileOrFolderThatIsGoneIsNamed) {
  const auto complaint = [](const auto& action) -> std::string {
    return words_of<LedgerError>(action);
  };
  const auto folder = folder_ / "results";
  std::filesystem::create_directories(folder / "tasks");
  Ledger ledger((folder / "tasks" / "0001.sqlite").string());
  ledger.write(full(), experiment_);
  EXPECT_EQ(complaint([&] { ledger.check_place(); }), "");
  const auto moved = folder_ / "elsewhere";
  std::filesystem::rename(folder, moved);
  for (const std::string& text : {complaint([&] { ledger.write(full(), experiment_); }),
                                  complaint([&] { ledger.check_place(); })}) {
    EXPECT_TRUE(text.starts_with("'" + folder.string() + "' was removed, moved or replaced"))
        << text;
    EXPECT_NE(text.find("ziggurat sweep resume"), std::string::npos) << text;
  }
  std::filesystem::rename(moved, folder);
  EXPECT_EQ(complaint([&] { ledger.write(full(), experiment_); }), "");
  std::filesystem::remove(folder / "tasks" / "0001.sqlite");
  const std::string text = complaint([&] { ledger.check_place(); });
  EXPECT_TRUE(text.starts_with("'" + (folder / "tasks" / "0001.sqlite").string() + "' was"))
      << text;
}

TEST_F(LedgerTest, AFileThatIsNoneIsNamed) {
  std::filesystem::create_directory(path_);
  EXPECT_TRUE(fails_with<LedgerError>("sweep.sqlite", [&] { Ledger ledger(path_); }));
}

}  // namespace
}  // namespace ziggurat::sweep

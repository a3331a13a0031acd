// SPDX-License-Identifier: MIT
#include "sweep/ledger.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "sweep/columns.h"

namespace ziggurat::sweep {
namespace {

constexpr int busy_ms = 10'000;         // wait for another program that reads or writes
constexpr int longest_value = 1 << 24;  // of a value, a row or a statement [bytes]

constexpr const char* schema = R"(
CREATE TABLE IF NOT EXISTS runs (
  run INTEGER PRIMARY KEY, seed INTEGER NOT NULL, outcome TEXT NOT NULL, exit_code INTEGER NOT NULL,
  ending TEXT NOT NULL, ticks INTEGER, simulated_s REAL, hash TEXT NOT NULL, robots INTEGER,
  failures INTEGER, dropped INTEGER, solver_not_converged INTEGER, solver_worst_residual REAL,
  wall_s REAL NOT NULL, version TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS parameters (
  run INTEGER NOT NULL REFERENCES runs, name TEXT NOT NULL, value NUMERIC NOT NULL,
  PRIMARY KEY (run, name)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS metrics (
  run INTEGER NOT NULL REFERENCES runs, name TEXT NOT NULL, value REAL,
  PRIMARY KEY (run, name)) WITHOUT ROWID;
)";

/// As SQL writes a name or a text: in these quotes, which are doubled inside.
std::string sql_text(std::string_view text, char quote) {
  std::string result(1, quote);
  for (const char c : text) {
    if (c == quote) result += c;
    result += c;
  }
  return result + quote;
}

/// A column of the view: what a table has for the run under a name.
std::string value_column(const char* table, const std::string& name, const std::string& column) {
  return fmt::format("(SELECT value FROM {0} WHERE {0}.run = runs.run AND {0}.name = {1}) AS {2}",
                     table, sql_text(name, '\''), sql_text(column, '"'));
}

/// Removes the last columns that have no room, and takes the room that the others have.
void shorten(std::vector<std::string>& columns, std::size_t& room, std::size_t& length) {
  std::size_t kept = 0;
  while (kept < columns.size() && room > 0 && columns[kept].size() <= length) {
    length -= columns[kept].size();
    --room;
    ++kept;
  }
  columns.resize(kept);
}

/// The outermost of a file and its folders that is not there.
std::string gone(const std::string& file) {
  std::filesystem::path path = file;
  std::error_code ignored;
  while (path.has_relative_path() && !std::filesystem::exists(path.parent_path(), ignored))
    path = path.parent_path();
  return path.string();
}

}  // namespace

class Ledger::Statement {
 public:
  Statement(const Ledger& ledger, const std::string& sql) : ledger_(ledger) {
    if (sqlite3_prepare_v2(ledger.database_, sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) {
      ledger.fail();
    }
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(std::int64_t value) { sqlite3_bind_int64(statement_, ++bound_, value); }
  void bind(double value) { sqlite3_bind_double(statement_, ++bound_, value); }
  void bind(const std::string& text) {
    sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()),
                      SQLITE_TRANSIENT);
  }
  void bind(const std::optional<std::uint64_t>& value) {
    if (!value) return static_cast<void>(++bound_);  // NULL
    bind(static_cast<std::int64_t>(*value));
  }
  void bind(const std::optional<double>& value) {
    if (!value) return static_cast<void>(++bound_);
    bind(*value);
  }

  /// False behind the last row.
  bool step() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) ledger_.fail();
    column_ = -1;
    return result == SQLITE_ROW;
  }
  void run() {
    step();
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
    bound_ = 0;
  }

  std::int64_t integer() { return sqlite3_column_int64(statement_, ++column_); }
  double number() { return sqlite3_column_double(statement_, ++column_); }
  std::string text() {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, ++column_));
    if (bytes == nullptr) return {};
    return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column_))};
  }
  std::optional<std::uint64_t> count_or_null() {
    const auto value = static_cast<std::uint64_t>(integer());
    return is_null() ? std::nullopt : std::optional(value);
  }
  std::optional<double> number_or_null() {
    const double value = number();
    return is_null() ? std::nullopt : std::optional(value);
  }

 private:
  bool is_null() const { return sqlite3_column_type(statement_, column_) == SQLITE_NULL; }

  const Ledger& ledger_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0, column_ = -1;
};

Ledger::Ledger(const std::string& path) : path_(path) {
  constexpr int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  try {
    if (sqlite3_open_v2(path.c_str(), &database_, flags, nullptr) != SQLITE_OK) fail();
    harden();
    sqlite3_busy_timeout(database_, busy_ms);
    execute("PRAGMA synchronous=FULL");
    execute(schema);
  } catch (...) {
    sqlite3_close(database_);
    throw;
  }
}

/// The file may be anyone's: nothing in it runs when it is read, and no value takes much memory.
void Ledger::harden() {
  for (const int option : {SQLITE_DBCONFIG_ENABLE_VIEW, SQLITE_DBCONFIG_ENABLE_TRIGGER,
                           SQLITE_DBCONFIG_TRUSTED_SCHEMA}) {
    sqlite3_db_config(database_, option, 0, nullptr);
  }
  sqlite3_db_config(database_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  for (const int limit : {SQLITE_LIMIT_LENGTH, SQLITE_LIMIT_SQL_LENGTH}) {
    sqlite3_limit(database_, limit, longest_value);
  }
}

Ledger::~Ledger() { sqlite3_close(database_); }

void Ledger::check_place() const {
  int has_moved = 0;
  sqlite3_file_control(database_, "main", SQLITE_FCNTL_HAS_MOVED, &has_moved);
  if (has_moved == 0) return;
  throw LedgerError(fmt::format(
      "'{}' was removed, moved or replaced while the sweep wrote to it. If it was moved, bring it "
      "back and "
      "write: ziggurat sweep resume DIR. If it was removed, its results are lost: begin again",
      gone(path_)));
}

void Ledger::fail() const {
  check_place();
  throw LedgerError(fmt::format("{}: {}", path_, sqlite3_errmsg(database_)));
}

void Ledger::execute(const std::string& sql) const {
  if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

Ledger::Statement Ledger::prepare(const std::string& sql) const { return Statement(*this, sql); }

void Ledger::write(const Result& result, const Experiment& experiment) {
  execute("BEGIN IMMEDIATE");
  try {
    for (const char* table : {"metrics", "parameters", "runs"}) {
      execute(fmt::format("DELETE FROM {} WHERE run = {}", table, result.run));
    }
    const auto run = static_cast<std::int64_t>(result.run);
    auto row = prepare("INSERT INTO runs VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
    row.bind(run);
    row.bind(static_cast<std::int64_t>(result.seed));
    row.bind(std::string(to_text(result.outcome)));
    row.bind(std::int64_t{result.exit_code});
    row.bind(result.ending);
    row.bind(result.ticks);
    row.bind(result.simulated_s);
    row.bind(result.hash);
    row.bind(result.robots);
    row.bind(result.failures);
    row.bind(result.dropped);
    row.bind(result.not_converged);
    row.bind(result.worst_residual);
    row.bind(result.wall_s);
    row.bind(result.version);
    row.run();
    auto value = prepare("INSERT INTO parameters VALUES (?,?,?)");
    const Combination values = combination(experiment, result.run);
    for (std::size_t i = 0; i < experiment.axes.size(); ++i) {
      value.bind(run);
      value.bind(experiment.axes[i].name);
      value.bind(values.values[i]);
      value.run();
    }
    auto metric = prepare("INSERT INTO metrics VALUES (?,?,?)");
    for (const auto& [name, number] : result.metrics) {
      metric.bind(run);
      metric.bind(name);
      metric.bind(number);
      metric.run();
    }
    execute("COMMIT");
  } catch (const LedgerError&) {
    sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
}

std::vector<Result> Ledger::read() const {
  std::vector<Result> results;
  execute("BEGIN");  // runs and metrics of one moment
  auto row = prepare("SELECT * FROM runs ORDER BY run");
  std::map<std::size_t, std::size_t> place_of;
  while (row.step()) {
    Result& result = results.emplace_back();
    result.run = static_cast<std::size_t>(row.integer());
    result.seed = static_cast<std::uint64_t>(row.integer());
    result.outcome = to_outcome(row.text()).value_or(Outcome::failed);
    result.exit_code = static_cast<int>(row.integer());
    result.ending = row.text();
    result.ticks = row.count_or_null();
    result.simulated_s = row.number_or_null();
    result.hash = row.text();
    result.robots = row.count_or_null();
    result.failures = row.count_or_null();
    result.dropped = row.count_or_null();
    result.not_converged = row.count_or_null();
    result.worst_residual = row.number_or_null();
    result.wall_s = row.number();
    result.version = row.text();
    place_of[result.run] = results.size() - 1;
  }
  auto metric = prepare("SELECT run, name, value FROM metrics");
  while (metric.step()) {
    const auto found = place_of.find(static_cast<std::size_t>(metric.integer()));
    std::string name = metric.text();
    const auto value = metric.number_or_null();
    if (found != place_of.end() && value) results[found->second].metrics[name] = *value;
  }
  execute("COMMIT");
  return results;
}

void Ledger::make_view(const Experiment& experiment) {
  const Columns columns = columns_of(experiment, read());
  std::vector<std::string> values, metrics, numbers, last;
  for (std::size_t i = 0; i < experiment.axes.size(); ++i) {
    values.push_back(value_column("parameters", experiment.axes[i].name, columns.axes[i]));
  }
  for (const auto& [metric, column] : columns.metrics) {
    metrics.push_back(value_column("metrics", metric, column));
  }
  for (const char* name : result_columns) numbers.push_back(fmt::format("runs.{0} AS {0}", name));
  for (const char* name : last_columns) last.push_back(fmt::format("runs.{0} AS {0}", name));
  // SQLite bounds the columns of a view and the length of a statement.
  std::size_t room = static_cast<std::size_t>(sqlite3_limit(database_, SQLITE_LIMIT_COLUMN, -1)) -
                     1 - numbers.size() - last.size();
  std::size_t length =
      static_cast<std::size_t>(sqlite3_limit(database_, SQLITE_LIMIT_SQL_LENGTH, -1)) / 2;
  for (auto* each : {&values, &metrics}) shorten(*each, room, length);
  std::string select = "runs.run AS run";
  for (const auto* each : {&values, &numbers, &metrics, &last}) {
    for (const std::string& column : *each) select += ", " + column;
  }
  execute("BEGIN IMMEDIATE");
  execute("DROP VIEW IF EXISTS results");
  execute(fmt::format("CREATE VIEW results AS SELECT {} FROM runs", select));
  execute("COMMIT");
}

}  // namespace ziggurat::sweep

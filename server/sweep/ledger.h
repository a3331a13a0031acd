// SPDX-License-Identifier: MIT
#pragma once
// The table of results: an SQLite file. A run is there when it is whole, otherwise not at all,
// whatever kills the program or the machine.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sweep/experiment.h"
#include "sweep/result.h"

struct sqlite3;

namespace ziggurat::sweep {

/// The file can't be read or written; the message names it and the cause.
class LedgerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Ledger {
 public:
  /// Opens the file, or creates it. @throws LedgerError
  explicit Ledger(const std::string& path);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  /// Adds a run with its values and metrics in one transaction, in place of an earlier one of the
  /// same number. It is on the disk when this returns. @throws LedgerError
  void write(const Result& result, const Experiment& experiment);

  /// By number. @throws LedgerError
  std::vector<Result> read() const;

  /// A view `results` for people: a row per run, a column per axis and metric. It leaves out the
  /// last of them if SQLite can't have as many columns. @throws LedgerError
  void make_view(const Experiment& experiment);

  /// Checks that the file is still where it was opened.
  /// @throws LedgerError, which says what is gone and what to do
  void check_place() const;

 private:
  void harden();
  void execute(const std::string& sql) const;
  class Statement;
  Statement prepare(const std::string& sql) const;
  [[noreturn]] void fail() const;

  std::string path_;
  sqlite3* database_ = nullptr;
};

}  // namespace ziggurat::sweep

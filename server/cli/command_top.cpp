// SPDX-License-Identifier: MIT
// Which controllers the world waits for: a table that is printed again and again.

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cmath>
#include <sstream>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/supervision_client.h"
#include "processes/signals.h"
#include "reports/console.h"
#include "text/numbers.h"
#include "ziggurat/error.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description top_options() {
  po::options_description options("Options", 96);
  options.add_options()("interval", po::value<std::string>()->value_name("S"),
                        "seconds of wall time between two tables (default 1)")(
      "once", "print one table, and end")("json", "a line of JSON for each table");
  add_key_options(options);
  return options;
}

/// Waits for this wall time; true if it was interrupted.
bool sleep(processes::Signals& signals, double seconds) {
  pollfd descriptor{signals.descriptor(), POLLIN, 0};
  poll(&descriptor, 1, static_cast<int>(std::lround(seconds * 1000)));
  return signals.take().interruptions > 0;
}

}  // namespace

std::string help_top() {
  std::ostringstream text;
  text << R"(usage: ziggurat top [URL] [OPTION]...

Shows which controllers a run of `ziggurat run --endpoint URL` or `ziggurat serve` waits for: every
controller with its state, how long the world has waited for it, how long it takes to answer, its
missed deadlines; and where the wall time of a tick goes. It does not slow the run. Ctrl-C ends it.
Without URL it is that of ZIGGURAT_ENDPOINT, or the only server that runs here.

  ziggurat top
  ziggurat top tcp://127.0.0.1:5770 --once --json

)" << top_options();
  return text.str();
}

int execute_top(const Arguments& arguments, processes::Signals& signals) {
  const Parsed parsed = parse(arguments, top_options());
  std::vector<std::string> words = parsed.positional;
  const std::string endpoint = take_endpoint(words);
  if (!words.empty()) throw text::UsageError("write: ziggurat top [URL]");
  check_apart(Values(parsed.values), "once", {"interval"});
  const bool once = parsed.values.count("once") > 0;
  const bool json = parsed.values.count("json") > 0;
  double interval = 1;
  if (const auto given = parsed.values.find("interval"); given != parsed.values.end()) {
    interval = text::to_number("--interval", given->second.as<std::string>());
    if (!(interval >= 0.05 && interval <= 3600)) {
      throw text::UsageError("--interval must be 0.05 to 3600 seconds");
    }
  }
  reports::Console console;
  SupervisorOptions options = supervisor_options(endpoint, parsed.values, "ziggurat top");
  options.only_observes = true;
  bool is_interrupted = false;
  options.is_interrupted = [&] { return is_interrupted |= signals.take().interruptions > 0; };
  const bool redraws = !once && !json && isatty(STDOUT_FILENO) != 0;
  try {
    const auto server = connect(std::move(options), console);
    do {
      const ServerStatus status = server->status();
      const std::string shown = json ? server->last_answer_json() : to_text(status);
      redraws ? console.redraw(shown) : console.result(shown);
      console.flush();
    } while (!once && !sleep(signals, interval));
  } catch (const ConnectionError& error) {
    if (!is_interrupted) throw;
    const int exit_code = signals.exit_code_of_interruption();
    signals.completed(exit_code);  // also if the sentence finds no reader
    console.fault(error.what());
    return exit_code;
  }
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli

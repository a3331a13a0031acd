// SPDX-License-Identifier: MIT
#include "sweep/sweep.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <system_error>

#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

constexpr int most_kills = 3;             // of a run by other programs, until that is its result
constexpr std::size_t most_messages = 5;  // on runs that failed
constexpr int wait_ms = 200;              // for signals; longest time between looks at the clock
constexpr std::chrono::seconds log_interval{60};  // of progress that is no line of a terminal
constexpr int interrupt_patience_ms = 250;        // for runs that were interrupted

}  // namespace

std::vector<std::size_t> runs_to_do(const std::vector<std::size_t>& runs,
                                    const std::vector<Result>& known, bool retries) {
  std::set<std::size_t> done;
  for (const Result& result : known) {
    if (!retries || result.outcome == Outcome::finished) done.insert(result.run);
  }
  std::vector<std::size_t> left;
  std::ranges::copy_if(runs, std::back_inserter(left),
                       [&](std::size_t run) { return !done.contains(run); });
  return left;
}

Sweep::Sweep(const Experiment& experiment, const Folder& folder, const Settings& settings,
             Ledger& ledger, reports::Console& console, processes::Signals& signals)
    : experiment_(experiment),
      folder_(folder),
      settings_(settings),
      ledger_(ledger),
      console_(console),
      signals_(signals) {}

Sweep::Counts Sweep::execute(const std::vector<std::size_t>& runs) {
  waiting_.assign(runs.begin(), runs.end());
  total_ = runs.size();
  while (!waiting_.empty() || !jobs_.empty()) {
    start_jobs();
    pollfd news{signals_.descriptor(), POLLIN, 0};
    ::poll(&news, 1, wait_ms);
    if (signals_.take().interruptions > 0) {
      interrupt();
      break;
    }
    for (auto& job : jobs_) {
      if (job->poll()) collect(*job);
    }
    std::erase_if(jobs_, [](const auto& job) { return job->process().ended(); });
    show_progress();
    console_.offer();
  }
  return counts_;
}

void Sweep::start_jobs() {
  while (jobs_.size() < settings_.jobs && !waiting_.empty()) {
    const std::size_t run = waiting_.front();
    waiting_.pop_front();
    try {
      jobs_.push_back(
          std::make_unique<Job>(experiment_, folder_, settings_, run, signals_.guardian()));
    } catch (const std::system_error&) {
      ledger_.check_place();  // which says more, if its folder is gone
      throw;
    }
  }
}

/// It has ended.
void Sweep::collect(Job& job) {
  if (job.was_killed() && ++kills_[job.run()] <= most_kills) {
    waiting_.push_front(job.run());
    return;
  }
  const Result result = job.result();
  ledger_.check_place();
  // First tidy, then write: a run with a row is never looked at again, and one without is repeated.
  tidy(folder_, result, settings_.record);
  ledger_.write(result, experiment_);
  wall_s_ += result.wall_s;
  if (result.outcome == Outcome::finished) {
    ++counts_.finished;
  } else {
    ++counts_.failed;
    report_failure(result);
  }
}

void Sweep::report_failure(const Result& result) {
  if (counts_.failed > most_messages) return;
  const std::string how = result.outcome == Outcome::timed_out
                              ? fmt::format("took longer than {} s", settings_.timeout.value_or(0))
                              : fmt::format("failed with exit code {}", result.exit_code);
  console_.warning(fmt::format(
      "run {} {}: {}{}", result.run, how, folder_.log_of(result.run).string(),
      counts_.failed == most_messages ? "; further runs that fail are only counted" : ""));
}

std::string Sweep::progress_text() const {
  const std::size_t done = counts_.finished + counts_.failed;
  std::string text = fmt::format("{} of {} runs ({:.0f} %)", done, total_,
                                 std::floor(100.0 * static_cast<double>(done) /
                                            static_cast<double>(std::max<std::size_t>(total_, 1))));
  if (counts_.failed > 0) text += fmt::format(", {} failed", counts_.failed);
  text += fmt::format(", {} running", jobs_.size());
  if (done > 0) {
    const double each = wall_s_ / static_cast<double>(done);
    const auto left = static_cast<double>(total_ - done);
    text += fmt::format(", {} left", text::to_duration(each * left / settings_.jobs));
  }
  return text;
}

void Sweep::show_progress() {
  const auto now = clock::now();
  if (console_.shows_progress()) {
    if (now - shown_at_ < std::chrono::milliseconds(wait_ms)) return;
    console_.progress(progress_text());
  } else {
    if (now - shown_at_ < log_interval) return;
    console_.report(progress_text());
  }
  shown_at_ = now;
}

void Sweep::interrupt() {
  counts_.is_interrupted = true;
  std::vector<processes::ChildProcess*> children;
  for (auto& job : jobs_) {
    job->process().signal(SIGTERM);
    children.push_back(&job->process());
  }
  processes::end_all(children, interrupt_patience_ms,
                     [&] { return signals_.take().interruptions > 0; });
  jobs_.clear();
}

}  // namespace ziggurat::sweep

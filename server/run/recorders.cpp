// SPDX-License-Identifier: MIT
#include "run/recorders.h"

#include <chrono>
#include <condition_variable>
#include <stop_token>
#include <utility>

namespace ziggurat::run {
namespace {

// Shorter than processes::Signals::patience: when the program is ended by force in a long tick, all
// that was written before is on the disk.
constexpr std::chrono::milliseconds flush_interval{400};

/// Calls it again and again, until it is stopped. It must not throw.
template <class Call>
std::jthread call_each(std::chrono::milliseconds interval, Call call) {
  return std::jthread([interval, call](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any end;
    std::unique_lock lock(mutex);
    while (end.wait_for(lock, stop, interval, [] { return false; }), !stop.stop_requested()) call();
  });
}

}  // namespace

Recorders::Recorders(const Options& options, const supervision::World& world) {
  const world::Layout& layout = world.simulation.layout();
  if (!options.trace.empty()) trace_.emplace(options.trace, layout);
  if (!options.hash_file.empty()) hashes_.emplace(options.hash_file);
  if (!options.readings.empty()) readings_.emplace(options.readings, layout);
  if (!options.summary.empty()) summary_.emplace(options.summary);
  if (!options.report_card.empty()) report_card_.emplace(options.report_card);
  report_card_text_ = &reports::to_json;
  if (options.report_card.ends_with(".svg")) report_card_text_ = &reports::to_svg;
  if (options.report_card.ends_with(".csv")) report_card_text_ = &reports::to_csv;
  if (!options.rays.empty()) rays_.emplace(options.rays, layout);
  if (options.pictures) {
    pictures_.emplace(*options.pictures, world.scene, world.simulation);
  }
  if (!options.images.empty()) images_.emplace(options.images, layout);
  const bool writes_each_tick = trace_ || hashes_ || readings_ || rays_;
  if (writes_each_tick) flushing_ = call_each(flush_interval, [this] { flush(); });
}

void Recorders::flush() {
  const std::lock_guard lock(mutex_);
  try {
    if (trace_) trace_->flush();
    if (hashes_) hashes_->flush();
    if (readings_) readings_->flush();
    if (rays_) rays_->flush();
  } catch (const outputs::WriteError&) {
    failed_flush_ = std::current_exception();
  }
}

void Recorders::report_failed_flush() {
  if (failed_flush_) std::rethrow_exception(std::exchange(failed_flush_, nullptr));
}

void Recorders::tick(const simulation::Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  report_failed_flush();
  if (trace_) trace_->write(simulation.state());
  if (hashes_) hashes_->write(simulation.state().tick, simulation.hash());
  if (rays_) rays_->write(simulation.state());
  if (images_) images_->write(simulation.observations());
  if (pictures_) pictures_->tick(simulation);
}

void Recorders::exchange(const world::State& state, const world::Observations& observations,
                         const world::Commands& commands,
                         const std::vector<world::Metric>& metrics) {
  const std::lock_guard lock(mutex_);
  report_failed_flush();
  if (readings_) readings_->write(state, observations, commands, metrics);
}

void Recorders::close() {
  flushing_ = {};
  std::exception_ptr first = std::exchange(failed_flush_, nullptr);
  const auto close = [&](auto& file) {
    if (!file) return;
    try {
      file->close();
    } catch (const std::runtime_error&) {
      if (!first) first = std::current_exception();
    }
  };
  close(trace_);
  close(hashes_);
  close(readings_);
  close(rays_);
  close(pictures_);
  if (first) std::rethrow_exception(first);
}

std::span<const std::string> Recorders::pictures() const {
  return pictures_ ? std::span(pictures_->taken()) : std::span<const std::string>();
}

std::string Recorders::missing_frames() const {
  return pictures_ ? pictures_->shortcoming() : std::string();
}

void Recorders::write_summary(const reports::Summary& summary) {
  if (!summary_) return;
  summary_->buffer().append(to_json(summary) + "\n");
  summary_->close();
}

void Recorders::write_report_card(const reports::ReportCard& card) {
  if (!report_card_) return;
  report_card_->buffer().append(report_card_text_(card));
  report_card_->close();
}

}  // namespace ziggurat::run

#include "run/recorders.h"

#include <exception>

namespace ziggurat::run {

Recorders::Recorders(const Options& options, const supervision::World& world) {
  const world::Layout& layout = world.simulation.layout();
  if (!options.trace.empty()) trace_.emplace(options.trace, layout);
  if (!options.hash_file.empty()) hashes_.emplace(options.hash_file);
  if (!options.readings.empty()) readings_.emplace(options.readings, layout);
  if (!options.summary.empty()) summary_.emplace(options.summary);
  if (!options.report_card.empty()) report_card_.emplace(options.report_card);
  report_card_is_picture_ = options.report_card.ends_with(".svg");
  if (!options.rays.empty()) rays_.emplace(options.rays, layout);
  if (options.pictures) {
    pictures_.emplace(*options.pictures, world.scene, world.simulation.entities(), layout);
  }
  if (!options.images.empty()) images_.emplace(options.images, layout);
}

void Recorders::tick(const simulation::Simulation& simulation) {
  if (trace_) trace_->write(simulation.state());
  if (hashes_) hashes_->write(simulation.state().tick, simulation.hash());
  if (rays_) rays_->write(simulation.state());
  if (images_) images_->write(simulation.observations());
  if (pictures_) pictures_->tick(simulation.state());
}

void Recorders::exchange(const world::State& state, const world::Observations& observations,
                         const world::Commands& commands) {
  if (readings_) readings_->write(state, observations, commands);
}

void Recorders::close() {
  std::exception_ptr first;
  const auto close = [&](auto& file) {
    if (!file) return;
    try {
      file->close();
    } catch (const recording::WriteError&) {
      if (!first) first = std::current_exception();
    }
  };
  close(trace_);
  close(hashes_);
  close(readings_);
  close(rays_);
  if (first) std::rethrow_exception(first);
}

std::span<const std::string> Recorders::pictures() const {
  return pictures_ ? std::span(pictures_->taken()) : std::span<const std::string>();
}

void Recorders::write_summary(const reports::Summary& summary) {
  if (!summary_) return;
  summary_->buffer().append(to_json(summary) + "\n");
  summary_->close();
}

void Recorders::write_report_card(const reports::ReportCard& card) {
  if (!report_card_) return;
  report_card_->buffer().append(report_card_is_picture_ ? to_svg(card) : to_json(card) + "\n");
  report_card_->close();
}

}  // namespace ziggurat::run

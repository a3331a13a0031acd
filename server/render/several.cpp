// SPDX-License-Identifier: MIT
#include "render/several.h"

#include <utility>

namespace ziggurat::render {

Several::Several(const scene::Scene& scene, std::vector<scene::Entity> entities,
                 world::Layout layout, unsigned threads)
    : layout_(std::move(layout)) {
  try {
    for (unsigned i = 0; i < threads; ++i) {
      threads_.emplace_back([this, renderer = Renderer(scene, entities, layout_)]() mutable {
        work(std::move(renderer));
      });
    }
  } catch (...) {  // there is no memory, or the system allows no more threads
    end();
    throw;
  }
}

Several::~Several() { end(); }

/// Waits for pictures that were begun.
void Several::end() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  news_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Several::work(Renderer renderer) {
  std::unique_lock lock(mutex_);
  Picture picture;
  for (;;) {
    news_.wait(lock, [this] { return is_over_ || !waiting_.empty(); });
    if (is_over_) return;
    Job job = std::move(waiting_.front());
    waiting_.pop_front();
    news_.notify_all();
    lock.unlock();
    do_job(job, renderer, picture);
    lock.lock();
    ++taken_;
    spare_.push_back(std::move(job));
    news_.notify_all();
  }
}

/// Draws at once, and waits with the picture for its turn.
void Several::do_job(Job& job, Renderer& renderer, Picture& picture) {
  std::exception_ptr failure;
  try {
    renderer.draw(job.state, job.view, picture);
  } catch (...) {
    failure = std::current_exception();
  }
  std::unique_lock lock(mutex_);
  news_.wait(lock, [&] { return taken_ == job.number; });
  if (has_failed_) return;
  if (!failure) {
    lock.unlock();
    try {
      job.take(picture);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
  }
  failure_ = failure;
  has_failed_ = failure != nullptr;
}

void Several::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Several::draw(const world::State& state, std::span<const world::Ray> rays, const View& view,
                   Take take) {
  std::unique_lock lock(mutex_);
  news_.wait(lock, [this] { return has_failed_ || waiting_.size() < threads_.size(); });
  rethrow();
  Job job;
  if (!spare_.empty()) {
    job = std::move(spare_.back());
    spare_.pop_back();
  }
  job.number = next_++;
  job.state = state;
  job.state.rays.assign(rays.begin(), rays.end());
  job.view = view;
  job.take = std::move(take);
  waiting_.push_back(std::move(job));
  news_.notify_all();
}

void Several::finish() {
  std::unique_lock lock(mutex_);
  news_.wait(lock, [this] { return taken_ == next_; });
  rethrow();
}

}  // namespace ziggurat::render

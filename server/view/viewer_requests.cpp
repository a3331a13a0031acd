// SPDX-License-Identifier: MIT
#include "view/viewer_requests.h"

#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace ziggurat::view {

ViewerRequests::ViewerRequests() : wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!wake_.is_open()) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void ViewerRequests::wake() {
  has_changes_ = true;
  ::eventfd_write(wake_.number(), 1);
}

void ViewerRequests::add_viewer(std::uint64_t viewer) {
  const std::lock_guard lock(mutex_);
  viewers_.insert(viewer);
  viewer_count_ = viewers_.size();
}

void ViewerRequests::remove_viewer(std::uint64_t viewer) {
  const std::lock_guard lock(mutex_);
  viewers_.erase(viewer);
  viewer_count_ = viewers_.size();
}

void ViewerRequests::set_wanted(std::vector<std::uint32_t> wanted, std::vector<std::uint32_t> fresh,
                                channels::Kinds kinds) {
  const std::lock_guard lock(mutex_);
  changes_.kinds = kinds;
  changes_.wanted = std::move(wanted);
  for (const std::uint32_t id : fresh) {
    if (std::ranges::find(changes_.fresh, id) == changes_.fresh.end()) changes_.fresh.push_back(id);
  }
  wake();
}

void ViewerRequests::add_call(ViewerCall call) {
  const std::lock_guard lock(mutex_);
  changes_.calls.push_back(std::move(call));
  wake();
}

void ViewerRequests::add_parameter(Parameter parameter) {
  const std::lock_guard lock(mutex_);
  std::erase_if(changes_.parameters,
                [&](const Parameter& old) { return old.name == parameter.name; });
  changes_.parameters.push_back(std::move(parameter));
  wake();
}

ViewerRequests::Changes ViewerRequests::take() {
  const std::lock_guard lock(mutex_);
  eventfd_t ignored = 0;
  ::eventfd_read(wake_.number(), &ignored);
  has_changes_ = false;
  Changes changes = changes_;
  changes_.fresh.clear();
  changes_.calls.clear();
  changes_.parameters.clear();
  std::ranges::sort(changes.fresh);
  return changes;
}

bool ViewerRequests::is_connected(std::uint64_t viewer) const {
  const std::lock_guard lock(mutex_);
  return viewers_.contains(viewer);
}

}  // namespace ziggurat::view

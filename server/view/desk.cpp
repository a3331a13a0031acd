#include "view/desk.h"

#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace ziggurat::view {

Desk::Desk() : wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!wake_.is_open()) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void Desk::wake() {
  has_news_ = true;
  ::eventfd_write(wake_.number(), 1);
}

void Desk::viewer_came(std::uint64_t viewer) {
  const std::lock_guard lock(mutex_);
  viewers_.insert(viewer);
  viewer_count_ = viewers_.size();
}

void Desk::viewer_left(std::uint64_t viewer) {
  const std::lock_guard lock(mutex_);
  viewers_.erase(viewer);
  viewer_count_ = viewers_.size();
}

void Desk::set_wanted(std::vector<std::uint32_t> wanted, std::vector<std::uint32_t> fresh,
                      channels::Kinds kinds) {
  const std::lock_guard lock(mutex_);
  news_.kinds = kinds;
  news_.wanted = std::move(wanted);
  for (const std::uint32_t id : fresh) {
    if (std::ranges::find(news_.fresh, id) == news_.fresh.end()) news_.fresh.push_back(id);
  }
  wake();
}

void Desk::add_call(Call call) {
  const std::lock_guard lock(mutex_);
  news_.calls.push_back(std::move(call));
  wake();
}

void Desk::add_wish(Parameter wish) {
  const std::lock_guard lock(mutex_);
  std::erase_if(news_.wishes, [&](const Parameter& old) { return old.name == wish.name; });
  news_.wishes.push_back(std::move(wish));
  wake();
}

Desk::News Desk::take() {
  const std::lock_guard lock(mutex_);
  eventfd_t ignored = 0;
  ::eventfd_read(wake_.number(), &ignored);
  has_news_ = false;
  News news = news_;
  news_.fresh.clear();
  news_.calls.clear();
  news_.wishes.clear();
  std::ranges::sort(news.fresh);
  return news;
}

bool Desk::is_there(std::uint64_t viewer) const {
  const std::lock_guard lock(mutex_);
  return viewers_.contains(viewer);
}

}  // namespace ziggurat::view

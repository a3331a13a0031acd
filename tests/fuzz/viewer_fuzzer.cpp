// SPDX-License-Identifier: MIT
// Messages of three viewers to the live server, behind WebSocket, two of them with the token,
// between ticks, spawns and answers. The queue of a viewer is bounded. Calls are only those of
// viewers with the token, and each is answered once.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "require.h"
#include "view/hub.h"

namespace {

using namespace ziggurat;
using channels::Kind;
using fuzz::require;

const channels::Schema schema{"ziggurat.v1.Poses", "descriptors"};

std::vector<channels::Channel> channel_list(Kind second) {
  std::vector<channels::Channel> list{{1, "/world", Kind::world, &schema, 0},
                                      {2, "/poses", Kind::poses, &schema, 0},
                                      {3, "/log", Kind::log, &schema, 0}};
  if (second == Kind::rays) list[1] = {4, "/rays", Kind::rays, &schema, 0};
  std::ranges::sort(list, {}, &channels::Channel::id);
  return list;
}

class Play {
 public:
  Play() {
    hub_.set_channels(channel_list(Kind::poses));
    using enum view::Permission;
    for (const auto each : {look, steer, steer}) ids_.push_back(hub_.add(each).id);
  }

  /// @param what  its lowest two bits: the viewer, the third: text
  void receive(std::uint8_t what, std::string_view message) {
    view::Viewer* viewer = hub_.find(ids_[what % 3]);
    if (!viewer) return;
    hub_.receive(*viewer, message,
                 (what & 4) != 0 ? view::Hub::Frame::text : view::Hub::Frame::binary);
    require(viewer->unanswered <= view::Hub::most_unanswered);
    require(viewer->may_steer || viewer->unanswered == 0);
    if (viewer->send_queue.size() >
        view::SendQueue::most_answers + view::SendQueue::most_frames + message.size() + 4096) {
      require(viewer->is_over);
    }
    if (viewer->is_over) hub_.remove(viewer->id);
  }

  void happen(std::uint8_t what) {
    if ((what & 8) != 0) show();
    if ((what & 16) != 0)
      hub_.set_channels(channel_list((what & 1) != 0 ? Kind::rays : Kind::poses));
    if ((what & 32) != 0)
      answer((what & 2) != 0 ? view::Hub::Outcome::done : view::Hub::Outcome::refused);
    if ((what & 64) != 0) read();
  }

 private:
  void show() {
    const std::string bytes(100, 'x');
    std::vector<channels::Message> messages;
    for (const std::uint32_t id : {1, 2, 3, 4}) {
      messages.push_back({id, time_, std::make_shared<const channels::Content>(bytes)});
    }
    hub_.show(++time_, messages);
  }

  void answer(view::Hub::Outcome outcome) {
    const view::ViewerRequests::Changes news = requests_.take();
    require(std::ranges::is_sorted(news.wanted));
    for (const view::ViewerCall& call : news.calls) {
      require(call.viewer != ids_[0]);
      hub_.answer(call, outcome, "{}");
    }
    for (const view::Parameter& parameter : news.parameters) hub_.set_parameter(parameter);
  }

  void read() {
    hub_.for_each([this](view::Viewer& viewer) {
      while (hub_.next(viewer)) {
      }
      require(viewer.send_queue.size() == 0);
    });
  }

  view::ViewerRequests requests_;
  view::Hub hub_{
      {"1", "s", "id", false}, {{"real_time_factor", 1.0}, {"phase", std::string("x")}}, requests_};
  std::vector<std::uint64_t> ids_;
  std::int64_t time_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Play play;
  std::span<const std::uint8_t> rest(data, size);
  while (rest.size() >= 3) {
    const std::uint8_t what = rest[0];
    const std::size_t length = std::min<std::size_t>(rest[1] | rest[2] << 8, rest.size() - 3);
    play.receive(what, {reinterpret_cast<const char*>(rest.data() + 3), length});
    play.happen(what);
    rest = rest.subspan(3 + length);
  }
  return 0;
}

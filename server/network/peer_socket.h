// SPDX-License-Identifier: MIT
#pragma once
// Socket of one connection: its input, cut into messages, and its output queue. No call blocks, and
// both directions are bounded.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "network/limits.h"
#include "network/link.h"
#include "network/output_queue.h"
#include "network/zmtp/engine.h"
#include "posix/descriptor.h"

namespace ziggurat::network {

/// Limits of connections without session do not hold for those of this user.
enum class Trust { none, own_user };

class PeerSocket {
 public:
  /// Whether input is left that next() has not looked at.
  bool has_turn = false;
  /// next() has looked at a part of what has arrived only.
  bool has_more = false;

  /// Sends the first bytes of the handshake.
  /// @param name  of the connection
  /// @param keys  must outlive the connection; null: it is not encrypted
  PeerSocket(std::string name, posix::Descriptor descriptor, const zmtp::CurveKeys* keys,
             Trust trust, Time now);

  const std::string& name() const { return name_; }
  int number() const { return descriptor_.number(); }
  bool is_trusted() const { return trust_ == Trust::own_user; }
  Standing standing() const { return standing_; }
  /// When it came to have no session.
  Time since() const { return since_; }
  /// @param longest  of its messages from now on [bytes]
  void set_standing(Standing standing, std::size_t longest, Time now);
  std::size_t longest() const { return longest_; }
  bool is_open() const { return engine_.is_open(); }  ///< the handshake is over
  /// The connection is gone, or must be closed.
  bool is_over() const { return is_over_; }
  /// Drops the output that waits.
  void give_up();
  /// Why it was closed for what the client sent, for people; empty if it was not.
  std::string fault() const;

  /// Reads once, a part of what is there. What next() gave is not valid any more.
  void read();
  /// The next message that has arrived completely, if there is one among the next few frames. Its
  /// access and bytes are set.
  /// @param limit  of its size [bytes]
  bool next(std::size_t limit, Received& received);

  /// Offset of the content in its frame, which has that many bytes more.
  std::size_t content_at(std::size_t content) const { return engine_.content_at(content); }
  /// Sends a frame with its content in place, now or as soon as the client reads. The connection is
  /// over if too much waits for it. A newer Observation takes the place of one that waits.
  /// @param frame  is taken if it has to wait
  void send(Buffer& frame, std::size_t content, MessageKind kind);
  /// Sends what waits, as far as that is possible.
  void flush();
  const OutputQueue& output() const { return output_; }
  /// Memory for what has arrived.
  std::size_t unfinished_bytes() const { return input_.capacity; }

 private:
  void enlarge();
  void let_go();
  bool has_input() const;
  bool take_frame(std::size_t limit, Received& received);
  bool end_message(bool goes_on, Received& received);
  void send_bytes(Buffer& frame, std::size_t size, MessageKind kind);
  void send_reply();

  const std::string name_;
  posix::Descriptor descriptor_;
  zmtp::Engine engine_;
  const Trust trust_;
  Standing standing_ = Standing::none;
  std::size_t longest_ = longest_without_session;
  Time since_;
  bool is_over_ = false;

  Buffer input_;  // what has arrived is from begin_ to end_
  std::size_t begin_ = 0, end_ = 0;
  std::size_t needed_ = 0;                               // of the frame that begins there
  bool has_frames_ = false;                              // of the message, before the one at begin_
  wire::Encoding first_frame_ = wire::Encoding::binary;  // its form, for the answer
  std::size_t to_skip_ = 0;                              // of a frame that is too long
  std::size_t skipped_ = 0;                              // bytes of the message that were not kept
  bool has_failed_ = false;    // the connection is over when its last reply is sent
  std::string too_long_;       // the sentence on the message that ended the connection
  bool more_to_skip_ = false;  // the message goes on behind that frame
  std::string reply_;
  OutputQueue output_;
};

}  // namespace ziggurat::network

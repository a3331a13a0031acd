#pragma once
// What the robots of a session send by radio with the next answer.

#include <cstddef>
#include <vector>

#include "ziggurat/radio.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

struct Radio::Traffic {
  struct Total {
    std::size_t messages = 0;
    std::size_t bytes = 0;
  };
  std::vector<Total> robots;  // by position in the session
  std::size_t bytes = 0;      // of the session, with what messages cost by themselves
  std::size_t max_bytes = 0;
  google::protobuf::RepeatedPtrField<v1::RadioMessage> messages;  // long-lived: keeps its memory

  void clear();

 private:
  std::size_t cleared_ = 0;  // [bytes] since `messages` last gave its memory back
};

}  // namespace ziggurat

// SPDX-License-Identifier: MIT
// One controller process of the lock-step benchmark.
//
// usage: bench_lockstep_client ziggurat ENDPOINT ROBOTS [SERVER_KEY SECRET_FILE]
//            through the client library
//        bench_lockstep_client bare ENDPOINT BYTES
//            answers each message with BYTES bytes

#include <zmq.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "ziggurat/ziggurat.h"

namespace {

/// Reads every encoder and sets every target, each tick.
void run_ziggurat(const std::vector<std::string>& arguments) {
  ziggurat::Options options;
  options.endpoint = arguments[0];
  options.robots = {arguments[1]};
  if (arguments.size() > 2) {
    options.server_key = arguments[2];
    options.curve_secret = arguments[3];
  }
  ziggurat::Session session(options);
  std::vector<ziggurat::Joint*> joints;
  for (ziggurat::Robot& robot : session.robots()) {
    for (ziggurat::Joint& joint : robot.joints()) joints.push_back(&joint);
  }
  while (session.next()) {
    for (ziggurat::Joint* joint : joints) joint->set_target(joint->encoder() + 1.0);
  }
}

void run_bare(const std::string& endpoint, std::size_t bytes) {
  void* context = zmq_ctx_new();
  void* dealer = zmq_socket(context, ZMQ_DEALER);
  zmq_connect(dealer, endpoint.c_str());
  zmq_send(dealer, "hello", 5, 0);
  zmq_msg_t frame;
  zmq_msg_init(&frame);
  while (zmq_msg_recv(&frame, dealer, 0) > 1) {  // one byte is the end
    zmq_msg_t answer;
    zmq_msg_init_size(&answer, bytes);
    zmq_msg_send(&answer, dealer, 0);
  }
  zmq_msg_close(&frame);
  zmq_close(dealer);
  zmq_ctx_term(context);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 6) return 1;
  if (std::string(argv[1]) == "bare") {
    run_bare(argv[2], std::strtoul(argv[3], nullptr, 10));
  } else {
    run_ziggurat({argv + 2, argv + argc});
  }
  return 0;
}

// SPDX-License-Identifier: MIT
#pragma once
// Answer to a request.

#include <string>

namespace ziggurat::http {

struct Answer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string etag;  ///< empty: the answer is not to be kept
  std::string body;
  std::string gzipped = {};   ///< the same body in gzip, for clients that take it; empty: none
  bool is_immutable = false;  ///< with an etag: never another body under this name
  std::string location = {};  ///< of a redirection (303): where to go; empty: none
  unsigned port =
      0;  ///< of a redirection to another port of the host that was called; 0: to this one
};

}  // namespace ziggurat::http

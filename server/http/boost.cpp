// SPDX-License-Identifier: MIT
// Non-template code of Boost.Asio and Boost.Beast, compiled once for all that include them.
#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>

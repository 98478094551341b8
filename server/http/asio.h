// Asio as the server uses it: coroutines that receive errors by value.
#pragma once

// Boost 1.74's awaitable.hpp uses std::exchange without including it.
#include <utility>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "server/http/error_code.h"

namespace milepost::server {

namespace net = boost::asio;

// A completion token: co_await returns the result and sets `error`.
inline auto awaited(error_code& error) { return net::redirect_error(net::use_awaitable, error); }

}  // namespace milepost::server

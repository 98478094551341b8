// How Asio and Beast tell of errors by value.
#pragma once

#include <boost/system/error_code.hpp>

namespace milepost::server {

using boost::system::error_code;

}  // namespace milepost::server

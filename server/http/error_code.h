// The error type of Asio and Beast.
#pragma once

#include <boost/system/error_code.hpp>

namespace milepost::server {

using boost::system::error_code;

}  // namespace milepost::server

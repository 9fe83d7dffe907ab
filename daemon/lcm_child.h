#pragma once

#include <string>

namespace anchord {

/// The first argument of the program that makes it receive LCM, on the URL that follows.
inline constexpr char kReceiveLcm[] = "--receive-lcm";
/// The descriptor on which it finds the daemon.
inline constexpr int kDaemonSocket = 3;

/// The process that receives LCM for the daemon: joins the network, says so, waits for a byte, then
/// passes on (see LcmRecord) what it hears on the daemon's channels until the daemon is gone. What
/// others send can bring liblcm down, and this process with it; it has nothing to lose. Each
/// message is checked, and decoded once here: what could bring down a decoder never reaches the
/// daemon. Returns the exit status.
int receive_lcm(const std::string& url);

}  // namespace anchord

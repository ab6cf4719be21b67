/// Amounts of memory on the command line.
#pragma once

#include <cstddef>
#include <string_view>

namespace parian {

/// Bytes: a number, also with decimals, and k, M, G or T for powers of 1000, or Ki, Mi, Gi or Ti for powers
/// of 1024, with a B behind them or none; capitals do not matter: 800M, 1.5GiB. Throws UsageError naming the
/// option (as --memory) for anything else, and for what is not above 0 or beyond what the machine can count.
std::size_t parse_bytes(std::string_view option, std::string_view text);

}  // namespace parian

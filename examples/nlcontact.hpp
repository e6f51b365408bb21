// SPDX-License-Identifier: BSD-2-Clause
// nlcontact.hpp - libnlcontact in C++11: a network that owns its memory, and errors that are thrown.
#ifndef NLCONTACT_HPP
#define NLCONTACT_HPP
#include <nlcontact.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace nlc {

struct error : std::runtime_error {
    nlc_status status;
    std::int64_t culprit;
    error(nlc_status s, std::int64_t c) : std::runtime_error(nlc_strerror(s) + (": " + std::to_string(c))), status(s), culprit(c) {}
};

// check([&](nlc_info *info) { return nlc_solve(..., info); }): warnings are returned, errors thrown with their culprit.
template <class Call> nlc_status check(Call call, nlc_info info = nlc_info())
{
    info.struct_size = sizeof info;
    const nlc_status status = call(&info);
    if (status < 0) throw error(status, info.culprit);
    return status;
}

class network {
    std::vector<std::uint64_t> memory; // moving a vector does not move what is in it
    nlc_network *built = nullptr;

public:
    network(const nlc_particles &particles, const std::vector<std::int32_t> &i, const std::vector<std::int32_t> &j,
            const nlc_options *options = nullptr)
        : memory(nlc_network_size(&particles, std::int64_t(i.size()), options) / 8 + 1)
    {
        check([&](nlc_info *info) {
            return nlc_network_init(&built, memory.data(), 8 * memory.size(), &particles, i.data(), j.data(),
                                    std::int64_t(i.size()), options, info);
        });
    }
    network(network &&) = default;
    network(const network &) = delete;
    operator nlc_network *() const { return built; }
};

} // namespace nlc
#endif

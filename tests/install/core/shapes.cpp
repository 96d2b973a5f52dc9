// SPDX-License-Identifier: MPL-2.0
// Without `thorough`, steady_shapes and branches find the same shapes, and say what they leave out.
#include <cstdio>
#include <revchain/branches.hpp>
#include <revchain/steady_shapes.hpp>
#include <string>

int main() {
#if defined(REVCHAIN_COMPILED)
    constexpr bool is_thorough = true;
#else
    constexpr bool is_thorough = false;
#endif
    const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
    const auto found = revchain::steady_shapes(chain, {.angular_speed = 9.0});
    for (const revchain::SteadyShape& shape : found.shapes)
        std::printf("%.14g %.14g\n", shape.inclination[0], shape.inclination[1]);
    const revchain::Branches diagram = revchain::branches(chain, {.max_angular_speed = 9.0});
    for (const revchain::Branch& branch : diagram.branches)
        std::printf("branch of mode %d, %s\n", static_cast<int>(branch.mode),
                    std::string(to_string(branch.end)).c_str());
    bool refused = false;
    try {
        const auto any = revchain::steady_shapes(chain, {.angular_speed = 9.0, .hanging_only = false});
        refused = any.shapes.size() <= found.shapes.size();
    } catch (const revchain::InvalidArgument& error) {
        refused = std::string(error.what()).find("revchain::thorough") != std::string::npos;
    }
    if (!found.complete || found.shapes.empty() || !diagram.consistent) return 1;
    if (diagram.complete != is_thorough || refused == is_thorough) return 2;
    return is_thorough || diagram.remark.find("revchain::thorough") != std::string::npos ? 0 : 3;
}

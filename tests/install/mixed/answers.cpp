// SPDX-License-Identifier: MPL-2.0
#include "answers.hpp"

#include <revchain/modes.hpp>
#include <revchain/steady_shapes.hpp>
#include <vector>

revchain::Vector<double> ANSWERS() {
    std::vector<double> numbers;
    const auto add = [&](const auto& found) {
        numbers.insert(numbers.end(), found.data(), found.data() + found.size());
    };
    for (int n = 2; n <= 30; n += 7) {
        std::vector<revchain::Link<double>> links;
        for (int m = 0; m < n; ++m)
            links.push_back(m % 2 == 0 ? revchain::plummet(1.0 + m, 0.5) : revchain::uniform_rod(2.0, 0.3 + 0.1 * m));
        const revchain::Chain<double> chain(links);
        const auto found = revchain::modes(chain, {.count = revchain::all_modes});
        add(found.conical_height), add(found.shapes());
    }
    const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
    for (const auto& shape : revchain::steady_shapes(chain, {.angular_speed = 9.0}).shapes)
        add(shape.inclination), add(shape.tension);
    return Eigen::Map<revchain::Vector<double>>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/parallel.hpp"

#include <algorithm>
#include <cfenv>
#include <mutex>
#include <set>

#include "support/catch.hpp"

using revchain::Cancelled;
using revchain::Index;
using revchain::InvalidArgument;
using revchain::Progress;
using revchain::detail::parallel_for;
using revchain::detail::Threads;

namespace {

/// Until `done` is true, 10 s at the most: what a test waits for has to happen on another thread.
template <class Done>
void wait_until(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!done() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

void stop_here() { throw std::runtime_error("stopped by the caller's look"); }

}  // namespace

TEST_CASE("parallel_for: each number once, in ranges that begin at multiples of the chunk", "[core]") {
    for (const Index threads : {0, 1, 2, 3, 7})
        for (const Index chunk : {1, 8, 48})
            for (const Index count : {0, 1, 7, 8, 9, 1000}) {
                const Threads used("test", threads);
                std::vector<std::atomic<int>> seen(static_cast<std::size_t>(count));
                std::atomic<bool> aligned = true;
                parallel_for(count, chunk, [&](Index begin, Index end) {
                    if (begin % chunk != 0 || (end % chunk != 0 && end != count) || begin >= end) aligned = false;
                    for (Index i = begin; i < end; ++i) ++seen[static_cast<std::size_t>(i)];
                });
                CAPTURE(threads, chunk, count);
                CHECK(aligned);
                CHECK(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
            }
}

TEST_CASE("parallel_for: one thread, or one chunk, is the caller's own, in one range", "[core]") {
    const auto alone = [](Index count, Index chunk) {
        int calls = 0;
        parallel_for(count, chunk, [&, caller = std::this_thread::get_id()](Index begin, Index end) {
            calls += begin == 0 && end == count && std::this_thread::get_id() == caller ? 1 : 100;
        });
        return calls == 1;
    };
    CHECK(alone(1000, 1));
    const Threads used("test", 3);
    CHECK(alone(8, 8));
    CHECK(alone(1, 1));
}

TEST_CASE("parallel_for: as many threads as asked for, and one each inside", "[core]") {
    const Threads used("test", 3);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    std::atomic<int> nested = 0;
    parallel_for(1000, 1, [&](int, int) {
        {
            const std::scoped_lock lock(mutex);
            threads.insert(std::this_thread::get_id());
        }
        wait_until([&] {
            const std::scoped_lock lock(mutex);
            return threads.size() == 3;
        });
        if (Threads::used() != 1) ++nested;
    });
    CHECK(threads.size() == 3);
    CHECK(nested > 0);  // the caller's ranges
}

TEST_CASE("the number of threads: nested, restored, checked", "[core]") {
    CHECK(Threads::used() == 1);
    {
        const Threads outer("test", 3);
        CHECK(Threads::used() == 3);
        {
            const Threads inner("test", 2);
            CHECK(Threads::used() == 2);
        }
        CHECK(Threads::used() == 3);
        CHECK_THROWS_AS(Threads("test", -1), InvalidArgument);
        CHECK(Threads::used() == 3);
        CHECK(Threads("test", 0).used() >= 1);
    }
    CHECK(Threads::used() == 1);
}

TEST_CASE("parallel_for: an exception reaches the caller, from any thread, and the others stop", "[core]") {
    const Threads used("test", 2);
    const auto caller = std::this_thread::get_id();
    for (const bool by_caller : {false, true}) {
        std::atomic<bool> thrown = false;
        const auto run = [&] {
            parallel_for(1000, 1, [&](Index begin, Index) {
                if ((std::this_thread::get_id() == caller) == by_caller) {
                    thrown = true;
                    throw InvalidArgument("number " + std::to_string(begin));
                }
                wait_until([&] { return thrown.load(); });
                if (by_caller)
                    for (;;)
                        revchain::detail::check_interrupt();  // ends by Cancelled, which is not what the caller gets
            });
        };
        CHECK_THROWS_AS(run(), InvalidArgument);
        CHECK(revchain::detail::abandoned == nullptr);
    }
    parallel_for(100, 1, [](int, int) {});  // nothing is left of it
}

TEST_CASE("parallel_for: cancelled by Progress on any thread", "[core]") {
    const Threads used("test", 3);
    Progress progress;
    std::atomic<int> ranges = 0;
    const auto run = [&] {
        parallel_for(1000, 1, [&](Index, Index) {
            if (++ranges == 3) progress.cancel();
            for (;;) revchain::detail::advance(&progress, 0.5);
        });
    };
    CHECK_THROWS_AS(run(), Cancelled);
    CHECK(ranges <= 3);
}

TEST_CASE("parallel_for: the caller looks while it waits, and stops the others", "[core]") {
    const Threads used("test", 2);
    const auto caller = std::this_thread::get_id();
    std::atomic<bool> helping = false;
    const auto run = [&] {
        parallel_for(2, 1, [&](Index, Index) {
            if (std::this_thread::get_id() == caller) {
                wait_until([&] { return helping.load(); });
                revchain::detail::interrupt = &stop_here;
                return;
            }
            helping = true;
            while (revchain::detail::interrupt == nullptr) std::this_thread::yield();
            wait_until([&] { return revchain::detail::abandoned->load(); });
            throw Cancelled("too late to be the first");
        });
    };
    CHECK_THROWS_WITH(run(), "stopped by the caller's look");
    revchain::detail::interrupt = nullptr;
}

TEST_CASE("parallel_for: helpers round as the caller does and raise none of its flags", "[core]") {
    const Threads used("test", 2);
    const auto caller = std::this_thread::get_id();
    std::feclearexcept(FE_ALL_EXCEPT);
    std::atomic<bool> helped = false;
    parallel_for(2, 1, [&](Index, Index) {
        if (std::this_thread::get_id() == caller) {
            wait_until([&] { return helped.load(); });
        } else {
            std::feraiseexcept(FE_DIVBYZERO);
            helped = true;
        }
    });
    CHECK(helped);
    CHECK(std::fetestexcept(FE_DIVBYZERO) == 0);
}

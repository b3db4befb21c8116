// SPDX-License-Identifier: Apache-2.0
// ThreadSanitizer cannot see how oneTBB hands work to threads, because that library is not instrumented. Here
// it is told, so that it reports races between the tasks and no others. Without the sanitizer all of this is
// nothing but the calls.
#pragma once

#include <utility>

#if defined(__SANITIZE_THREAD__)
#define NEARLIGHT_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define NEARLIGHT_THREAD_SANITIZER 1
#endif
#endif

#ifdef NEARLIGHT_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
// A task's own fields are copied by oneTBB from thread to thread, unseen.
#define NEARLIGHT_UNSEEN __attribute__((no_sanitize("thread")))
#else
#define NEARLIGHT_UNSEEN
#endif

namespace nearlight::core {

/// Lives as long as one call of tbb::parallel_*: what was done before it, the tasks see, and what they did is
/// seen after it.
class ForkJoin {
  public:
    ForkJoin() { leave(&forked_); }
    ~ForkJoin() { enter(&joined_); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;

    /// The work, which must outlive the call, as a task for oneTBB.
    template <typename Work>
    auto task(const Work& work) {
        return Task<Work>{&work, &forked_, &joined_};
    }
    /// What combines the results of two tasks, which must outlive the call, as oneTBB takes it.
    template <typename Work>
    auto combination(const Work& work) {
        return Task<Work>{&work, &joined_, &joined_};
    }

  private:
    template <typename Work>
    struct Task {
        const Work* work;
        char* before;
        char* after;

        template <typename... Arguments>
        NEARLIGHT_UNSEEN decltype(auto) operator()(Arguments&&... arguments) const {
            struct Exit {
                char* mark;
                NEARLIGHT_UNSEEN ~Exit() { leave(mark); }
            };
            enter(before);
            const Exit exit{after};
            return (*work)(std::forward<Arguments>(arguments)...);
        }
    };

    NEARLIGHT_UNSEEN static void enter([[maybe_unused]] char* mark) {
#ifdef NEARLIGHT_THREAD_SANITIZER
        __tsan_acquire(mark);
#endif
    }
    NEARLIGHT_UNSEEN static void leave([[maybe_unused]] char* mark) {
#ifdef NEARLIGHT_THREAD_SANITIZER
        __tsan_release(mark);
#endif
    }

    char forked_ = 0;
    char joined_ = 0;
};

}  // namespace nearlight::core

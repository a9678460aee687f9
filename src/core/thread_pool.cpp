#include "osculate/core/thread_pool.hpp"

#include <atomic>
#include <cfenv>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace osculate {
namespace {

thread_local bool inside_a_task = false;

/// Waits for one task at a time.
class Worker {
public:
    /// @param before  workers that there are already
    explicit Worker(Index before) : looks_(most_looks / (1 + before / few)), thread_([this] { work(); }) {}
    ~Worker() { set(State::ended); }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void begin(const std::function<void(Index)>& task, Index item, const std::fenv_t& environment) {
        task_ = &task;
        item_ = item;
        environment_ = environment;
        set(State::working);
    }
    void wait() { wait_while(State::working); }

private:
    enum class State { idle, working, ended };

    void set(State state) {
        state_.store(state, std::memory_order_release);
        state_.notify_all();
    }
    static constexpr Index most_looks = 2000; ///< some 50 us
    static constexpr Index few = 8;           ///< workers; of many, each looks less, in case they share a processor

    /// Looks often at first, as loops follow one another: to wake a thread takes as long as a short loop.
    void wait_while(State state) const {
        for (Index look = 0; look < looks_; ++look) {
            if (state_.load(std::memory_order_acquire) != state) return;
#if defined(__x86_64__)
            __builtin_ia32_pause();
#endif
        }
        state_.wait(state, std::memory_order_acquire);
    }
    void work() {
        inside_a_task = true;
        while (true) {
            wait_while(State::idle);
            if (state_.load(std::memory_order_acquire) == State::ended) return;
            std::fesetenv(&environment_);
            (*task_)(item_);
            set(State::idle);
        }
    }

    Index looks_;
    std::atomic<State> state_ = State::idle;
    const std::function<void(Index)>* task_ = nullptr;
    Index item_ = 0;
    std::fenv_t environment_{};
    std::jthread thread_; ///< last: it uses the rest
};

} // namespace

void run_side_by_side(Index count, const std::function<void(Index)>& task) {
    static std::mutex busy;
    static std::vector<std::unique_ptr<Worker>> workers;
    std::unique_lock lock(busy, std::defer_lock);
    if (count <= 1 || inside_a_task || !lock.try_lock()) {
        for (Index i = 0; i < count; ++i) task(i);
        return;
    }
    while (static_cast<Index>(workers.size()) < count - 1)
        workers.push_back(std::make_unique<Worker>(static_cast<Index>(workers.size())));
    std::fenv_t environment;
    std::fegetenv(&environment);
    for (Index i = 1; i < count; ++i) workers[static_cast<std::size_t>(i - 1)]->begin(task, i, environment);
    inside_a_task = true;
    task(0);
    inside_a_task = false;
    for (Index i = 1; i < count; ++i) workers[static_cast<std::size_t>(i - 1)]->wait();
}

} // namespace osculate

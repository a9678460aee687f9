#include "osculate/core/thread_pool.hpp"

#include <cfenv>
#include <condition_variable>
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
    Worker() : thread_([this](const std::stop_token& stop) { work(stop); }) {}
    ~Worker() {
        thread_.request_stop();
        {
            const std::lock_guard lock(mutex_); // not between its look at the token and its sleep
        }
        changed_.notify_all();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void begin(const std::function<void(Index)>& task, Index item, const std::fenv_t& environment) {
        {
            const std::lock_guard lock(mutex_);
            task_ = &task;
            item_ = item;
            environment_ = environment;
        }
        changed_.notify_all();
    }
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return task_ == nullptr; });
    }

private:
    void work(const std::stop_token& stop) {
        inside_a_task = true;
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [&] { return task_ != nullptr || stop.stop_requested(); });
            if (task_ == nullptr) return;
            std::fesetenv(&environment_);
            lock.unlock();
            (*task_)(item_);
            lock.lock();
            task_ = nullptr;
            changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    const std::function<void(Index)>* task_ = nullptr; ///< null: none, or done
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
    while (static_cast<Index>(workers.size()) < count - 1) workers.push_back(std::make_unique<Worker>());
    std::fenv_t environment;
    std::fegetenv(&environment);
    for (Index i = 1; i < count; ++i) workers[static_cast<std::size_t>(i - 1)]->begin(task, i, environment);
    inside_a_task = true;
    task(0);
    inside_a_task = false;
    for (Index i = 1; i < count; ++i) workers[static_cast<std::size_t>(i - 1)]->wait();
}

} // namespace osculate

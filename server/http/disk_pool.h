// Threads for what may wait for a disk, so that the threads of the sockets never do.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace milepost::server {

// Safe to use from several threads at once.
class DiskPool {
 public:
  using Task = std::function<void()>;  // throws nothing

  // REQUIRES: threads >= 1. `queue` tasks may wait for a thread.
  DiskPool(unsigned threads, std::size_t queue);
  ~DiskPool();  // stop()
  DiskPool(const DiskPool&) = delete;
  DiskPool& operator=(const DiskPool&) = delete;

  // False if the queue is full: nothing will be done.
  bool try_run(Task task);
  // For the rest of an answer that has begun: of these there are no more than connections.
  void run(Task task);
  // Waits for the tasks that are being run, and drops those that wait.
  void stop();

 private:
  void work();

  const std::size_t queue_;
  std::vector<std::thread> threads_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> waiting_;  // guarded by mutex_
  bool stopped_ = false;      // guarded by mutex_
};

}  // namespace milepost::server

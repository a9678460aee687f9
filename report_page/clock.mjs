// The moment that view and plots show.

export const clock = {
  times: [],
  frame: 0,
  listeners: [],
  get time() {
    return this.times[this.frame];
  },
  listen(listener) {
    this.listeners.push(listener);
  },
  /// Before all that listens is made anew.
  forget() {
    this.listeners = [];
  },
  show(frame) {
    this.frame = Math.max(0, Math.min(this.times.length - 1, frame));
    for (const listener of this.listeners) listener();
  },
  /// The frame nearest to a time.
  seek(time) {
    let nearest = 0;
    this.times.forEach((t, f) => {
      if (Math.abs(t - time) < Math.abs(this.times[nearest] - time)) nearest = f;
    });
    this.show(nearest);
  },
};

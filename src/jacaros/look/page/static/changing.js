/** Something that changes, and calls its listeners then. */
export class Changing {
  listeners = new Set();

  /** Call `listener` after each change; returns the function that ends this. */
  onChange(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  notify() { for (const listener of this.listeners) listener(); }
}

state(idle).
@w[atomic] +!work <- -+state(half); .wait(150); -+state(done).

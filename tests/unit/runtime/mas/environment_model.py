"""A model of artifacts and observers, written from the documentation, that shares no code with them.

A script is a list of steps such as ``["def", "p", 1]``; the artifact ``Puppet`` runs a script, and `Model` computes
what every observer must perceive, and how the operation must end.
"""

NAMES = ("p", "q", "go")
OBSERVERS = ("ann", "bob", "s1", "s2")


class Thing:
    """An artifact: its properties (all, and as observers know them), who focuses it, who waits for a turn."""

    def __init__(self, name):
        self.name = name
        self.properties, self.published, self.touched = {}, {}, {}
        self.observers, self.queue = [], []

    def first(self, name):
        return next((key for key in sorted(self.properties) if self.properties[key][0] == name), None)


class Doing:
    """An operation under way."""

    def __init__(self, number, thing, kind, script, limit):
        self.number, self.thing, self.script, self.limit = number, thing, script, limit
        self.at = 0
        self.guard = "go" if kind == "guarded" else None


class Model:
    """What ought to happen.

    Attributes:
        events: what each observer must have noticed since that was last cleared.
        beliefs: what each must believe.
        outcomes: how operations must have ended.
    """

    def __init__(self):
        self.now, self.serial = 0.0, 0
        self.things, self.asleep, self.outcomes = {}, [], {}
        self.events = {each: [] for each in OBSERVERS}
        self.beliefs = {each: [] for each in OBSERVERS}

    def focused(self, observer):
        return sorted(thing.name for thing in self.things.values() if observer in thing.observers)

    def under_way(self, thing):
        return len(thing.queue) + sum(doing.thing is thing for _, doing in self.asleep)

    # ---- what is observed

    def tell(self, observer, kind, thing, what):
        seen = (thing.name, *what)
        self.events[observer].append((kind, *seen))
        if kind == "+":
            self.beliefs[observer].append(seen)
        elif kind == "-":
            self.beliefs[observer].remove(seen)

    def publish(self, thing, signal=None, addressee=None):
        changes = [(thing.published.get(key), thing.properties.get(key)) for key in thing.touched]
        thing.published, thing.touched = dict(thing.properties), {}
        for observer in thing.observers:
            if signal and addressee in (None, observer):
                self.tell(observer, "~", thing, signal)
            for old, new in changes:
                if old and new:
                    self.tell(observer, "-", thing, old)
                    self.tell(observer, "+", thing, new)
            for old, new in changes:
                if new and not old:
                    self.tell(observer, "+", thing, new)
            for old, new in changes:
                if old and not new:
                    self.tell(observer, "-", thing, old)

    def focus(self, observer, name):
        if name not in self.things:
            return "gone"
        thing = self.things[name]
        if observer not in thing.observers:
            thing.observers.append(observer)
            for key in sorted(thing.published):
                self.tell(observer, "+", thing, thing.published[key])
        return "ok"

    def stop(self, observer, name):
        if name not in self.things:
            return "gone"
        self.lose(observer, self.things[name])
        return "ok"

    def lose(self, observer, thing):
        if observer in thing.observers:
            thing.observers.remove(observer)
            for key in sorted(thing.published):
                self.tell(observer, "-", thing, thing.published[key])

    # ---- artifacts come and go

    def make(self, name, script):
        if name in self.things:
            return "makeArtifactFailure"
        thing = Thing(name)
        if self.go_on(Doing(None, thing, "init", script, None)) is not None:
            return "makeArtifactFailure"
        self.publish(thing)
        self.things[name] = thing
        return "ok"

    def dispose(self, name, survivor=None):
        if name not in self.things:
            return "gone"
        thing = self.things[name]
        self.publish(thing)
        del self.things[name]
        for observer in tuple(thing.observers):
            self.lose(observer, thing)
        for doing in [*thing.queue, *(each for _, each in self.asleep if each.thing is thing)]:
            if doing is not survivor:
                self.end(doing, "artifact_disposed")
        return "ok"

    # ---- operations

    def begin(self, number, name, kind, script, timeout):
        if name not in self.things:
            self.outcomes[number] = "gone"
            return
        thing = self.things[name]
        doing = Doing(number, thing, kind, script, None if timeout is None else self.now + timeout)
        if doing.guard is None or thing.first(doing.guard):
            self.drive(doing)
            self.serve(thing)
        else:
            thing.queue.append(doing)

    def end(self, doing, how):
        self.outcomes[doing.number] = how
        doing.thing.queue = [each for each in doing.thing.queue if each is not doing]
        self.asleep = [each for each in self.asleep if each[1] is not doing]

    def cancel(self, number, how="cancelled"):
        for thing in tuple(self.things.values()):
            for doing in [*thing.queue, *(each for _, each in self.asleep if each.thing is thing)]:
                if doing.number == number:
                    self.end(doing, how)
                    self.serve(thing)

    def serve(self, thing):
        """The first waiting operation that may continue does so, and then all are checked again."""
        while True:
            ready = (each for each in thing.queue if each.guard is None or thing.first(each.guard))
            doing = next(ready, None)
            if doing is None:
                return
            thing.queue.remove(doing)
            self.drive(doing)

    def drive(self, doing):
        """Do steps until the operation ends or has to wait."""
        thing = doing.thing
        while True:
            reached = self.go_on(doing)
            if reached not in ("fail", "raise"):
                self.publish(thing)
            if isinstance(reached, list):
                kind, wanted = reached
                if kind == "sleep":
                    self.asleep.append((self.now + wanted, doing))
                    return
                if thing.first(wanted):
                    continue
                doing.guard = wanted
                thing.queue.append(doing)
                return
            self.end(doing, {"fail": "refused", "raise": "operation_error", None: "ok"}[reached])
            return

    def go_on(self, doing):
        """Up to a boundary (the step), a failure (its kind) or the end (None)."""
        thing = doing.thing
        while doing.at < len(doing.script):
            step = kind, *rest = doing.script[doing.at]
            doing.at += 1
            if kind in ("sleep", "until"):
                return step
            if kind in ("fail", "raise"):
                thing.properties, thing.touched = dict(thing.published), {}
                return kind
            if kind == "signal":
                self.publish(thing, tuple(rest))
            elif kind == "signal_to":
                self.publish(thing, tuple(rest[1:]), rest[0])
            elif kind == "dispose":
                self.dispose(thing.name, doing)
            else:
                self.change(thing, kind, *rest)
        return None

    def change(self, thing, kind, name, value=None):
        if kind == "def":
            self.serial += 1
            key = self.serial
        else:
            key = thing.first(name)
        if key is None:
            return
        thing.touched.setdefault(key)
        if kind == "remove":
            del thing.properties[key]
        else:
            thing.properties[key] = (name, value)

    # ---- time

    def advance(self, seconds):
        until = self.now + seconds
        while True:
            waiting = [each for thing in self.things.values() for each in thing.queue]
            waiting += [doing for _, doing in self.asleep]
            due = [(each.limit, False, each) for each in waiting if each.limit is not None]
            due += [(when, True, doing) for when, doing in self.asleep]
            when, wakes, doing = min(due, key=lambda each: each[0], default=(until + 1, False, None))
            if when > until:
                break
            self.now = when
            if wakes:
                self.asleep.remove((when, doing))
                self.drive(doing)
                self.serve(doing.thing)
            else:
                self.cancel(doing.number, "operation_timeout")
        self.now = until

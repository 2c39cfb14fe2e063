package tools;

import cartago.*;
import java.util.*;

/** A buffer of limited size. It has a journal. */
@ARTIFACT_INFO(outports = { @OUTPORT(name = "journal") })
public class Buffer extends Artifact {
    private LinkedList<Object> items = new LinkedList<>();
    private Map<String, Integer> counts = new HashMap<>();
    private int size;
    static final int LIMIT = 100;

    void init(int size) {
        this.size = Math.min(size, LIMIT);
        defineObsProperty("count", 0);
        defineObsProperty("range", 0, 10);
    }

    /** Put an item in. */
    @OPERATION(guard = "notFull")
    void put(String item) {
        items.add(item);
        counts.put(item, counts.getOrDefault(item, 0) + 1);
        getObsProperty("count").updateValue(items.size());
    }

    @OPERATION(guard = "notEmpty")
    void get(OpFeedbackParam<Object> item) {
        ObsProperty count = getObsProperty("count");
        item.set(items.removeFirst());
        count.updateValue(count.intValue() - 1);
    }

    @GUARD boolean notFull(String item) { return items.size() < size; }
    @GUARD boolean notEmpty(OpFeedbackParam<Object> item) { return !items.isEmpty(); }

    @OPERATION void widen(int by) {
        getObsProperty("range").updateValue(1, 10 + by / 2);
        getObsProperty("range").updateValues(by, getObsProperty("range").intValue(1));
    }

    @OPERATION void report(String title, OpFeedbackParam<String> line) {
        String text = title + ":";
        for (Map.Entry<String, Integer> entry : counts.entrySet()) {
            text += " " + entry.getKey() + "=" + entry.getValue();
        }
        int total = 0;
        for (int i = 0; i < items.size(); i++) {
            if (items.get(i) == null) continue;
            total++;
        }
        line.set(text + ", total " + total + (total > 1 ? " items" : " item"));
    }

    @OPERATION void write(String line) {
        try {
            execLinkedOp("journal", "append", line);
        } catch (Exception e) {
            failed("no journal", "no_journal", line);
        }
    }

    @OPERATION void flush() {
        if (items.isEmpty()) failed("nothing to flush", "empty", getId().getName());
        execInternalOp("drain", 100);
    }

    @INTERNAL_OPERATION void drain(long pause) {
        while (!items.isEmpty()) {
            await_time(pause);
            items.removeFirst();
            getObsProperty("count").updateValue(items.size());
            signal("dropped", items.size());
        }
    }

    @OPERATION void waitUntilEmpty() {
        await("empty");
        System.out.println("empty for " + getCurrentOpAgentId().getAgentName());
    }

    @GUARD boolean empty() { return items.isEmpty(); }

    /* A name that artifacts have in Python, and two operations of one name. */
    @OPERATION void start(int x) { signal("started", x % 3, -x / 2); }
    @OPERATION void start(int x, int y) { signal("started", x, y); }

    @OPERATION void grade(int points, OpFeedbackParam<String> grade) {
        switch (points) {
            case 10:
            case 9: grade.set("good"); break;
            case 8: grade.set("fair"); break;
            default: grade.set("poor");
        }
    }

    @OPERATION void save(String file) {
        String line = "items: " + items;
        java.io.FileWriter writer = new java.io.FileWriter(file);
        writer.write(line);
    }
}

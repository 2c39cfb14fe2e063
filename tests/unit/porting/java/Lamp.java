import jason.asSyntax.*;
import jason.environment.Environment;
import java.util.logging.Logger;

public class Lamp extends Environment {
    static Logger logger = Logger.getLogger("lamp");
    public static final Literal on = Literal.parseLiteral("press(on)");
    int brightness = 0;

    @Override
    public void init(String[] args) {
        super.init(args);
        if (args.length == 1) {
            brightness = Integer.parseInt(args[0]);
        }
        update();
    }

    void update() {
        clearPercepts();
        addPercept(Literal.parseLiteral("brightness(" + brightness + ")"));
        if (brightness > 0) {
            addPercept(ASSyntax.createLiteral("lit"));
        }
    }

    @Override
    public boolean executeAction(String agent, Structure action) {
        logger.info(agent + " does " + action);
        if (action.equals(on)) {
            brightness = 100;
        } else if (action.getFunctor().equals("dim")) {
            int by = (int) ((NumberTerm) action.getTerm(0)).solve();
            if (by > brightness) return false;
            brightness -= by;
        } else if (action.getFunctor().equals("wait")) {
            try { Thread.sleep(500); } catch (Exception e) {}
        } else {
            return false;
        }
        update();
        informAgsEnvironmentChanged();
        return true;
    }
}

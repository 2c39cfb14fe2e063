// AgentSpeak in the Jason dialect, after src/jacaros/agents/language/grammar.ebnf. It accepts a little more than the parser:
// for colours and folding, a program with a mistake is better than no program.

const LEVEL = { or: 1, and: 2, not: 3, relation: 4, sum: 5, product: 6, power: 7, sign: 8 };

const separated = (rule) => seq(rule, repeat(seq(",", rule)));
const binary = ($, side, level, operator, left, right = left) =>
  side(level, seq(field("left", left), field("operator", operator), field("right", right)));

module.exports = grammar({
  name: "agentspeak",
  word: ($) => $.name,
  extras: ($) => [/\s/, $.comment],
  conflicts: ($) => [
    [$.belief_change, $.signed], // `+X` changes beliefs where a step begins, but `(-X + 1) < Y` is a condition
  ],

  inline: ($) => [$._prefix, $._namespace, $._target, $._directive],

  rules: {
    program: ($) => repeat($._clause),
    _clause: ($) => choice($.belief, $.rule, $.initial_goal, $.plan, $.sub_plans, $.directive, $.block),

    belief: ($) => seq($.literal, "."),
    rule: ($) => seq($._rule, "."),
    _rule: ($) => seq(field("head", $.literal), ":-", field("body", $._condition)),
    initial_goal: ($) => seq("!", $.literal, "."),

    directive: ($) => seq("{", $._directive, optional("."), "}"),
    block: ($) => seq("{", "begin", $._directive, optional("."), "}", repeat($._clause), "{", "end", "}"),
    _directive: ($) => field("name", $.literal),

    plan: ($) => seq(optional($.label), $.trigger, optional($._parts), choice(".", seq($.sub_plans, optional(".")))),
    sub_plans: ($) => seq("{", repeat(choice($.plan, $.sub_plans)), "}"),
    label: ($) => seq("@", choice($.annotations, $._target)),
    trigger: ($) => choice(seq(choice("+", "-", "^"), $._target), $._goal_trigger),
    _goal_trigger: ($) => seq(choice("+", "-", "^"), choice("!", "?"), $._target),
    _target: ($) => choice($.literal, $.variable_term),
    _parts: ($) =>
      choice(
        seq($._context, optional($._goal_condition), optional($._arrow)),
        seq($._goal_condition, optional($._arrow)),
        seq(optional(":"), $._arrow), // the thesis of JaCaROS prints empty contexts
      ),
    _context: ($) => seq(":", field("context", $._condition)),
    _goal_condition: ($) => seq("<:", field("goal_condition", $._condition)),
    _arrow: ($) => seq("<-", field("body", $.body)),

    body: ($) => $._steps,
    _steps: ($) =>
      prec.right(
        choice(
          seq($._plain, optional(seq(";", optional($._steps)))),
          seq($._statement, optional(";"), optional($._steps)),
        ),
      ),
    _plain: ($) => choice($._simple, $.fork),
    fork: ($) => choice(...["|||", "|&|"].map((sign, level) => binary($, prec.left, level, sign, $._factor))),
    _factor: ($) => choice($._simple, $._statement, $.fork),
    _simple: ($) => choice($.goal, $.test, $.belief_change, $.group, $._condition),
    goal: ($) => seq(choice("!", "!!"), $._target),
    test: ($) => seq("?", $._condition),
    belief_change: ($) =>
      prec.dynamic(1, seq(choice("+", "-", "-+", "++", "--", "+<", "+>", "^"), choice($._target, $.braces))),
    group: ($) =>
      seq("(", choice(seq($._plain, ";", optional($._steps)), seq($._statement, optional(";"), optional($._steps)), $._lone), ")"),
    _lone: ($) => choice($.goal, $.test, $.belief_change, $.fork, $.group),
    _statement: ($) => choice($.if, $.while, $.for),
    if: ($) =>
      seq("if", $._guarded, repeat(seq("elif", $._guarded)), optional(seq("else", $._block))),
    while: ($) => seq("while", $._guarded),
    for: ($) => seq("for", $._guarded),
    _guarded: ($) => seq("(", field("condition", $._condition), ")", $._block),
    _block: ($) => seq("{", optional($.body), "}"),

    _condition: ($) => choice($.binary, $.not, $._sum),
    binary: ($) =>
      choice(
        binary($, prec.right, LEVEL.or, "|", $._condition),
        binary($, prec.right, LEVEL.and, "&", $._condition),
        binary($, prec.left, LEVEL.relation, choice("<", "<=", ">", ">=", "==", "\\==", "=", "=.."), $._condition),
      ),
    not: ($) => prec.right(LEVEL.not, seq("not", $._condition)),
    _sum: ($) => choice($.arithmetic, $.signed, $._primary),
    arithmetic: ($) =>
      choice(
        binary($, prec.left, LEVEL.sum, choice("+", "-"), $._sum),
        binary($, prec.left, LEVEL.product, choice("*", "/", "div", "mod"), $._sum),
        binary($, prec.right, LEVEL.power, "**", $._sum),
      ),
    signed: ($) => prec(LEVEL.sign, seq(choice("+", "-"), choice($.number, $.variable_term, $.action, $.parentheses, $.signed))),
    _primary: ($) =>
      choice($.number, $.string, $.literal, $.variable_term, $.action, $.list, $.braces, $.parentheses, $.boolean),
    parentheses: ($) => seq("(", $._condition, ")"),

    literal: ($) =>
      prec.right(seq(optional($._prefix), field("functor", $._atom), optional($.arguments), optional($.annotations))),
    variable_term: ($) => prec.right(seq(optional($._prefix), $.variable, optional($.annotations))),
    _prefix: ($) => choice(seq(optional($._namespace), "::", optional("~")), seq("~", optional(seq(optional($._namespace), "::")))),
    _namespace: ($) => field("namespace", choice($._atom, $.dotted, $.variable)),
    action: ($) => prec.right(seq(field("name", $.dotted), optional($.arguments))),
    arguments: ($) => seq("(", optional(separated($._condition)), ")"),
    annotations: ($) => seq("[", optional(separated(choice($._sum, $.while_annotation))), optional($._tail), "]"),
    while_annotation: ($) => seq("while", $.arguments),
    list: ($) => seq("[", optional(separated($._sum)), optional($._tail), "]"),
    _tail: ($) => seq("|", field("tail", $._primary)),

    braces: ($) =>
      seq(
        "{",
        choice(
          optional($.body),
          alias($._goal_trigger, $.trigger),
          alias($._plan_term, $.plan),
          seq(alias($._rule, $.rule), optional(".")),
        ),
        "}",
      ),
    _plan_term: ($) =>
      choice(
        seq($.label, $.trigger, optional($._parts), optional(".")),
        seq($.trigger, $._parts, optional(".")),
        seq($.trigger, "."),
      ),

    _atom: ($) => choice($.name, $.quoted_name),
    name: () => /[a-z]\w*/,
    quoted_name: () => /'[^'\n]*'/,
    dotted: () => /([a-z]\w*)?(\.[A-Za-z_]\w*)+/,
    variable: () => /[A-Z_]\w*/,
    boolean: () => choice("true", "false"),
    number: () => /([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]+)?/,
    string: () => /"([^"\\\n]|\\[^\n])*"/,
    comment: () => token(choice(/\/\/[^\n]*/, /\/\*([^*]|\*+[^*/])*\*+\//)),
  },
});

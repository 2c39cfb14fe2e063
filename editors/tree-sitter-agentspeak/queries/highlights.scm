(comment) @comment
(string) @string
(number) @number
(boolean) @boolean
(variable) @variable
(quoted_name) @string.special

(literal functor: (_) @property)
(action name: (dotted) @function.builtin)

(trigger "!" (literal functor: (_) @function))
(trigger "?" (literal functor: (_) @function))
(goal (literal functor: (_) @function.call))
(initial_goal (literal functor: (_) @function.call))
(body (literal functor: (_) @function.method.call))

(label (literal functor: (_) @label))
(annotations (literal functor: (_) @attribute))
(literal namespace: (_) @module)

(directive name: (literal functor: (_) @keyword.directive))
(block name: (literal functor: (_) @keyword.directive))
["begin" "end"] @keyword.directive

["if" "elif" "else"] @keyword.conditional
["while" "for"] @keyword.repeat
["not" "div" "mod"] @keyword.operator

[
  "<-" ":-" "<:" ":" "!" "!!" "?" "+" "-" "-+" "++" "--" "+<" "+>" "^" "@" "~" "|&|" "|||"
  "|" "&" "<" "<=" ">" ">=" "==" "\\==" "=" "=.." "*" "/" "**"
] @operator
["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["." ";" "," "::"] @punctuation.delimiter

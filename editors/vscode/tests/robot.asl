// SYNTAX TEST "source.agentspeak" "programs"

{ include("lib.asl") }
//^^^^^^^ keyword.control.directive.agentspeak
//        ^^^^^^^^^ string.quoted.double.agentspeak

!start.
//<- keyword.operator.goal.agentspeak
 //^^ entity.name.function.goal.agentspeak

near(X) :- at(X, 0.5) & not X < -3e2 | .member(X, [a, 'B c']). // why
// <---- entity.name.type.belief.agentspeak
//   ^ variable.other.agentspeak
//      ^^ keyword.operator.arrow.agentspeak
//               ^^^ constant.numeric.agentspeak
//                      ^^^ keyword.operator.word.agentspeak
//                               ^^^ constant.numeric.agentspeak
//                                     ^^^^^^^ support.function.action.agentspeak
//                                                    ^^^^^ string.quoted.single.agentspeak
//                                                             ^^^^^^^ comment.line.double-slash.agentspeak

@stop[atomic] +!stop : true <- if (far) { ns::move(25) } else { !!rest }; -+at(home); math.abs(X) > 1.
// <- punctuation.definition.label.agentspeak
// <~--- entity.name.label.agentspeak
//            ^^ keyword.operator.goal.agentspeak
//              ^^^^ entity.name.function.goal.agentspeak
//                     ^^^^ constant.language.agentspeak
//                          ^^ keyword.operator.arrow.agentspeak
//                             ^^ keyword.control.agentspeak
//                                        ^^ entity.name.namespace.agentspeak
//                                                       ^^^^ keyword.control.agentspeak
//                                                              ^^ keyword.operator.goal.agentspeak
//                                                                ^^^^ entity.name.function.goal.agentspeak
//                                                                        ^^ keyword.operator.belief.agentspeak
//                                                                          ^^ entity.name.type.belief.agentspeak
//                                                                                    ^^^^^^^^ support.function.action.agentspeak

+b : c <- a |&| b; .print("a \" b // c", X).
//        ^ entity.name.type.belief.agentspeak
//          ^^^ keyword.operator.concurrency.agentspeak
//                 ^^^^^^ support.function.action.agentspeak
//                           ^^ constant.character.escape.agentspeak
//                                ^^ string.quoted.double.agentspeak - comment

/* a long
   p(X) :- q. comment */ p.
// ^ comment.block.agentspeak
//                       ^ entity.name.type.belief.agentspeak

// A bumper plan beside 1000 intentions that never rest, laser scans, and bursts of readings (see reactivity.py).
!start.

+!start
  <- makeArtifact("bumper", "Bumper", [], Bumper);
     makeArtifact("load", "Load", [], Load);
     makeArtifact("scan", "ArtBaseScan", [], Scan);
     focus(Bumper);
     focus(Load);
     focus(Scan);
     for (.range(I, 1, 1000)) {
        !!work(I, 0);
     }.

@bump[urgency(10)]
+bumped(N)
  <- stop(N).

+reading(1)
  <- handled.

+reading(N)
  <- -+newest(N).

+laserrange(A, B, C, D, E) : C < 0.7
  <- !avoid(A + B, D + E).

+laserrange(_, _, C, _, _)
  <- -+free(C).

+!avoid(Right, Left) : Right > Left
  <- -+turn(right).

+!avoid(_, _)
  <- -+turn(left).

+!work(I, N)
  <- -+state(I, N);
     !work(I, (N * 7 + I) mod 1000).  // jacaros: ignore loop-without-wait (busy on purpose)

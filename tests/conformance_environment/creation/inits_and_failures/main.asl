!go.
+!go <-
  makeArtifact("a","Box",[],A); makeArtifact("b","Box",[5],B); makeArtifact("c","Box",["red",6],C);
  focus(A); focus(B); focus(C);
  .findall(box(N,X,S),box(X,S)[artifact_name(N)],L); .sort(L,Sorted); .print(Sorted);
  !try("d",["red",6,7]); !try("e",[2.5]); !try("f",[-1]); !try("g",[0]); !try("h",[99]);
  makeArtifact("f","Box",[1]); .print("the name is free");
  .stopMAS.
+!try(N,Args) <- makeArtifact(N,"Box",Args); .print("never").
-!try(N,Args)[error(E),env_failure_reason(R)] <- .print(E," ",R).

;; Counts its samples in its memory, in a global and in its linear memory, and asks for what it finds in these: a law in
;; continuous time, too.
(module
  (memory (export "memory") 1)
  (global $calls (mut f64) (f64.const 0))
  (data (i32.const 0) "{\"title\": \"Counter\", \"parameters\": [{\"name\": \"k\", \"default\": 2, \"range\": [0, 9]}], \"memory\": [{\"name\": \"n\"}], \"shown\": [{\"name\": \"calls\"}]}\00")
  (func (export "declaration") (result i32) (i32.const 0))
  (func (export "region") (result i32) (i32.const 8192))
  (func (export "start") (param i32 i32 i32)
    (f64.store (local.get 2) (f64.const 10)))
  (func (export "decide") (param $told i32) (param $own i32) (param $memory i32) (param $shown i32) (param $command i32)
    (f64.store (local.get $memory) (f64.add (f64.load (local.get $memory)) (f64.const 1)))
    (global.set $calls (f64.add (global.get $calls) (f64.const 1)))
    (f64.store (i32.const 4096) (f64.add (f64.load (i32.const 4096)) (f64.const 1)))
    (f64.store (local.get $shown) (f64.add (global.get $calls) (f64.load (i32.const 4096))))
    (f64.store (local.get $command) (f64.mul (f64.load (local.get $own)) (f64.load (local.get $memory))))
    ;; The distance to the leader: number 5 of what it is told.
    (f64.store (i32.add (local.get $command) (i32.const 8)) (f64.load (i32.add (local.get $told) (i32.const 40)))))
  (func (export "derive") (param $told i32) (param $own i32) (param $memory i32) (param $rates i32) (param $command i32)
    (f64.store (local.get $rates) (f64.load (local.get $own)))
    (f64.store (local.get $command) (f64.load (local.get $memory)))
    (f64.store (i32.add (local.get $command) (i32.const 8)) (f64.const 0))))
